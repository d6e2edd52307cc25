// Recording 2, .broadmark: for changing worlds, and for large, mostly static ones. A frame holds
// only changes; periodic key frames hold all boxes and allow seeking. docs/recordings.md
// describes the bytes; recording.h has the writer.
//
// Example:
//
//   const auto changesOf = [](const std::filesystem::path& path, std::uint32_t index) {
//     Recording2Reader recording(path);         // or openRecordingFile(), for any format
//     const Frame frame = recording.at(index);  // its boxes, filter and changes
//     return frame.changed->size();
//   };
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/hasher.h"
#include "broadmark/large_array.h"
#include "broadmark/recordings/recording.h"

namespace broadmark {

struct FrameLayout;

/// A frame's index entry, in file layout.
struct RecordedFrame {
  std::uint64_t offset;   ///< of its first byte
  std::uint32_t changed;  ///< number of changed bodies
  std::uint32_t key;      ///< index of the last key frame up to and including this one
  HashValue hash;         ///< of its bytes
};

/// Reads a .broadmark recording. Absent bodies have kEmptyBox; all changes are listed. The
/// next frame costs its changes, or a whole frame if it is a key frame; the latest frame again
/// costs nothing. Any other frame takes its key frame and the changes after it: with our writer at
/// most two whole frames. If filters change, a frame with changed groups costs O(bodies).
class Recording2Reader final : public Recording {
 public:
  /// Opens a file, whatever its extension, and checks header and index. Throws InputError, as does
  /// the other constructor.
  explicit Recording2Reader(const std::filesystem::path& path);
  /// Reads from an open descriptor, and takes ownership of it; `name` is used in messages.
  Recording2Reader(FileDescriptor file, std::string name);

  [[nodiscard]] const RecordingOrigin& origin() const override { return origin_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;
  [[nodiscard]] std::optional<std::span<const std::uint32_t>> changed() const override {
    return std::span(ids_).first(changed_);
  }
  [[nodiscard]] const CollisionFilter* filter() const override {
    return scene().filter_changes ? &filter_ : nullptr;
  }
  [[nodiscard]] std::span<const std::uint32_t> filterChanged() const override {
    return std::span(filter_ids_).first(filter_changed_);
  }

  /// Reads and validates header and index.
  void open();
  /// Reads the header of `size` bytes. Returns the offset of the frames.
  std::uint64_t readHeader(std::uint64_t size, std::uint64_t index_offset);
  void readIndex(std::uint64_t offset);
  [[nodiscard]] FrameLayout layoutOf(std::uint32_t index) const;
  void checkIndex(std::uint64_t begin, std::uint64_t end) const;
  /// Advances boxes_ to a frame: a key frame, or the successor of current_.
  void readFrame(std::uint32_t index);
  /// Reads the `count` changed ids at an offset into `ids`.
  void readIds(std::uint32_t index, std::uint64_t offset, std::uint32_t count,
               std::vector<std::uint32_t>& ids);
  void readAllBoxes(std::uint32_t index, bool follows);
  void readChangedBoxes(std::uint32_t index);
  void readFilter(std::uint32_t index, bool follows);
  /// Calls visit(row, box) for each box of a frame.
  template <class Visit>
  void readBoxRows(std::uint32_t index, Visit&& visit);
  /// Calls visit(row, its bytes) for rows at an offset.
  template <class Visit>
  void readRows(std::uint64_t offset, std::uint64_t count, std::uint64_t row_bytes, Visit&& visit);
  /// Throws InputError: about the checksum if it is wrong, else with `what`.
  [[noreturn]] void fail(std::uint32_t index, const std::string& what);
  [[noreturn]] void failAt(std::uint32_t index, std::uint64_t row, const std::string& what);
  [[noreturn]] void failAt(std::uint32_t index, std::uint64_t row, const Aabb& box);

  RecordingOrigin origin_;
  std::vector<RecordedFrame> index_;
  LargeVector<Aabb> boxes_;
  std::vector<std::uint32_t> ids_;
  std::uint32_t changed_ = 0;             ///< number of valid entries
  std::optional<std::uint32_t> current_;  ///< the frame in these and the following members
  // If filters change.
  std::vector<std::uint32_t> filter_counts_;  ///< by frame: bodies with a changed filter
  std::vector<std::uint32_t> filter_ids_;
  std::uint32_t filter_changed_ = 0;  ///< number of valid entries
  std::vector<BodyGroups> groups_;
  CollisionFilter filter_;          ///< of groups_
  bool filter_is_current_ = false;  ///< groups_ have not changed since
  std::vector<std::byte> piece_;    ///< part of a frame being read
  Hasher hasher_;
};

}  // namespace broadmark
