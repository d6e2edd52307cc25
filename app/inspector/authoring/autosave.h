// Copies of unsaved scenes, which survive the end of the process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/files.h"
#include "inspector/session/document.h"

namespace broadmark {

/// $XDG_STATE_HOME/broadmark/scenes, or below ~/.local/state.
std::filesystem::path autosaveFolder();

/// Writes the document's unsaved changes to a folder, shared by all processes: scene-N.json is the
/// scene, scene-N.lock holds the path of its own file, and is locked while its process lives.
class Autosave {
 public:
  /// `folder`: "": nothing is written.
  explicit Autosave(std::filesystem::path folder);

  /// A scene that a process left behind.
  struct Left {
    std::size_t slot = 0;
    std::string title;  ///< the name of the scene's file, or the scene's
  };
  [[nodiscard]] const std::vector<Left>& left() const { return left_; }
  /// Opens such a scene, without confirmation. Throws InputError.
  void recover(const Left& left, Document& document);

  /// Call once per picture. Throws InputError, once.
  void update(const Document& document, double seconds);
  /// Removes the copy: the user has decided about unsaved changes.
  void discard();

 private:
  /// Identifies the written state.
  struct State {
    std::uint64_t loads = 0;
    std::uint64_t revision = 0;
    std::filesystem::path path;

    friend bool operator==(const State&, const State&) = default;
  };

  [[nodiscard]] std::filesystem::path file(std::size_t slot, const char* extension) const;
  /// The locked file of a slot; nothing: another process has it.
  [[nodiscard]] std::optional<FileDescriptor> lock(std::size_t slot) const;
  void claimSlot();
  void write(const Document& document);

  std::filesystem::path folder_;
  std::vector<Left> left_;
  std::optional<std::pair<std::size_t, FileDescriptor>> own_;  ///< the slot, with its lock
  std::optional<State> written_;
  double waited_seconds_ = 0;
  double interval_seconds_ = 0;
};

}  // namespace broadmark
