// Recording 2, .broadmark: for worlds that change, and for large, mostly still ones. A frame holds
// only what changed, and every so often all boxes: a key frame, from which seeking begins.
// docs/recordings.md describes the bytes; recording.h has the writer.
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

/// What the index of a recording 2 says of a frame, as it lies in the file.
struct RecordedFrame {
  std::uint64_t offset;   ///< where it begins
  std::uint32_t changed;  ///< how many bodies changed
  std::uint32_t key;      ///< the last key frame up to this one, perhaps itself
  HashValue hash;         ///< of its bytes
};

/// Reads a .broadmark recording. Absent bodies have kEmptyBox; Frame::changed is always known. The
/// next frame costs what changed; any other one at most two whole frames and what changed in it.
class Recording2Reader final : public Recording {
 public:
  explicit Recording2Reader(const std::filesystem::path& path);
  /// The same from an open descriptor, which this takes over; `name` stands for it in messages.
  Recording2Reader(FileDescriptor file, std::string name);

  [[nodiscard]] const RecordingOrigin& origin() const override { return origin_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;
  [[nodiscard]] std::optional<std::span<const std::uint32_t>> changed() const override {
    return std::span(ids_).first(changed_);
  }

  /// Reads header and index, and checks that they are whole.
  void open();
  /// Of this size; returns where the frames begin.
  std::uint64_t readHeader(std::uint64_t size, std::uint64_t index_offset);
  void readIndex(std::uint64_t offset);
  void checkIndex(std::uint64_t begin, std::uint64_t end) const;
  /// Makes `boxes_` those of a frame: a key frame, or the one after `current_`.
  void readFrame(std::uint32_t index);
  void readIds(std::uint32_t index);
  void readAllBoxes(std::uint32_t index, bool follows);
  void readChangedBoxes(std::uint32_t index);
  /// Hands the boxes of a frame to take(row, box).
  template <class Take>
  void readRows(std::uint32_t index, Take&& take);
  /// Throws InputError: a wrong checksum if that is so, else what is said.
  [[noreturn]] void fail(std::uint32_t index, const std::string& what);
  [[noreturn]] void failAt(std::uint32_t index, std::uint64_t row, const std::string& what);
  [[noreturn]] void failAt(std::uint32_t index, std::uint64_t row, const Aabb& box);

  RecordingOrigin origin_;
  std::vector<RecordedFrame> index_;
  LargeVector<Aabb> boxes_;
  std::vector<std::uint32_t> ids_;
  std::uint32_t changed_ = 0;             ///< so many of them count
  std::optional<std::uint32_t> current_;  ///< the frame that boxes_ and ids_ hold
  std::vector<std::byte> piece_;          ///< of a frame, while it is read
  Hasher hasher_;
};

}  // namespace broadmark
