// Where a scene is put together: the document with its history, the file it lives in, the brush.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "inspector/footage.h"
#include "broadmark/scenes/brush.h"
#include "broadmark/scenes/scene_editor.h"

namespace broadmark {

struct FootageRequest;

/// One document at a time; at first it is empty.
class AuthorDesk {
 public:
  AuthorDesk();

  /// Takes another document, with no history. `unsaved`: it stands in no file as it is.
  void start(scenes::AuthoredScene scene, std::filesystem::path path = {}, bool unsaved = false);
  /// Writes the document, which lives in that file from then on; `path` gets its extension if it
  /// has none. Throws InputError.
  void save(std::filesystem::path path);

  /// The file that the document lives in; "": none yet.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// What people call the document: the file's name, or the scene's.
  [[nodiscard]] std::string title() const;
  /// Whether something would be lost with the document.
  [[nodiscard]] bool isModified() const { return unsaved_ || editor.isModified(); }

  /// What opens the bodies where they start. Independent of later edits. O(bodies).
  [[nodiscard]] std::function<std::unique_ptr<Footage>()> still() const;
  /// What opens the simulation; likewise.
  [[nodiscard]] std::function<std::unique_ptr<Footage>()> live() const;
  /// The simulation itself, of a copy. Throws InputError.
  [[nodiscard]] std::unique_ptr<Simulation> simulation() const;

  /// Takes another brush, by its place in `brushes`.
  void chooseBrush(std::size_t which);
  [[nodiscard]] std::size_t chosenBrush() const { return chosen_brush_; }
  [[nodiscard]] scenes::Brush& brush() { return *brush_; }
  /// Paints once and selects what was added. Returns how many bodies found no room. Throws
  /// InputError.
  std::size_t addStroke();

  scenes::SceneEditor editor;
  const std::vector<scenes::BrushEntry> brushes = scenes::brushEntries();
  scenes::Paint paint;
  Vec3 paint_at{};  ///< where the brush paints

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
