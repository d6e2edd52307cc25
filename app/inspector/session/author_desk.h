// What a scene is put together on: the document with its history, its file, the brush, the tools.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "broadmark/scenes/brush.h"
#include "broadmark/scenes/scene_editor.h"
#include "inspector/run/footage.h"
#include "inspector/session/tools.h"

namespace broadmark {

struct FootageRequest;

/// At first the document is empty.
class AuthorDesk {
 public:
  AuthorDesk();

  /// Takes another document, with no history. `unsaved`: no file holds it as it is.
  void start(scenes::AuthoredScene scene, std::filesystem::path path = {}, bool unsaved = false);
  /// Writes the document to what becomes its file; `path` gets its extension if it has none. Throws
  /// InputError.
  void save(std::filesystem::path path);

  /// The document's file; "": none yet.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The document's name for people: that of the file, or of the scene.
  [[nodiscard]] std::string title() const;
  /// Whether it has unsaved changes.
  [[nodiscard]] bool isModified() const { return unsaved_ || editor.isModified(); }

  // Both are independent of later edits. O(bodies).
  /// Opens the bodies where they start.
  [[nodiscard]] FootageOpener still() const;
  /// Opens the simulation.
  [[nodiscard]] FootageOpener live() const;
  /// The simulation itself, of a copy. Throws InputError.
  [[nodiscard]] std::unique_ptr<Simulation> simulation() const;

  /// Takes another brush, by its index in `brushes`.
  void chooseBrush(std::size_t which);
  [[nodiscard]] std::size_t chosenBrush() const { return chosen_brush_; }
  [[nodiscard]] scenes::Brush& brush() { return *brush_; }
  [[nodiscard]] const scenes::Brush& brush() const { return *brush_; }
  /// What the brush paints at `paint_at`. Throws InputError.
  [[nodiscard]] scenes::Stroke stroke() const;

  scenes::SceneEditor editor;
  const std::vector<scenes::BrushEntry> brushes = scenes::brushEntries();
  scenes::Paint paint;
  Vec3 paint_at{};  ///< where stroke() paints
  Tools tools;

 private:
  std::filesystem::path path_;
  bool unsaved_ = false;
  std::size_t chosen_brush_ = 0;
  std::unique_ptr<scenes::Brush> brush_;
};

/// Frame `frame` of whatever the request opens, as a document; what does not exist yet is
/// simulated. Throws InputError when it holds what no body can be.
scenes::AuthoredScene sceneFromFootage(const FootageRequest& request, std::uint32_t frame);

/// The document's bodies where they start, as a scene of a single frame.
std::unique_ptr<Footage> stillOf(const scenes::AuthoredScene& scene);

}  // namespace broadmark
