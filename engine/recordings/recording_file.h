// Shared code of the recording formats: validation, the file writer, and the original's header.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <future>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/frame.h"
#include "broadmark/hasher.h"
#include "broadmark/recordings/posrot.h"
#include "broadmark/recordings/recording.h"

namespace broadmark {

/// The name of a scene made from this one: with a suffix, within kMaxNameLength.
inline std::string suffixedName(const SceneInfo& scene, std::string_view suffix) {
  return scene.name.substr(0, kMaxNameLength - suffix.size()).append(suffix);
}

/// Bytes of a box or a pose in a set.
inline constexpr std::size_t kRecordBytes = 32;

/// The header in file layout.
struct RecordingHeader {
  char name[128];
  char object_type[128];
  std::int32_t objects;
  std::int32_t frames;
  std::int32_t zero[2];
  Aabb world;
};

/// Parses a header. Throws InputError with `name` and the byte offset of the fault.
SceneInfo parseHeader(const RecordingHeader&, const std::string& name);

/// Byte offset of set `set`.
std::uint64_t setOffset(const SceneInfo&, std::uint64_t set);

/// Throws InputError for names that recordings cannot hold.
void requireNames(const SceneInfo&);
/// Whether the text is valid as the name of a scene or an object type.
bool isName(std::string_view text);

/// The fault of a record; "": none.
std::string fault(const Aabb&);
std::string fault(const Pose&);

/// A branchless validity check. Comparisons with NaN are false.
inline bool isSound(const Aabb& box) {
  constexpr float kHuge = std::numeric_limits<float>::max();
  // All axes at once: a corner is a SIMD register. Both compilers have this extension.
  using Corner = float __attribute__((vector_size(16)));
  const auto low = std::bit_cast<Corner>(box.min);
  const auto high = std::bit_cast<Corner>(box.max);
  const Corner huge = {kHuge, kHuge, kHuge, kHuge};
  const auto sound = (low <= high) & (low >= -huge) & (high <= huge);
  return (sound[0] & sound[1] & sound[2]) != 0;
}

/// Whether a recording 2 may hold the box: a sound box, or the empty box if bodies may be absent.
inline bool isRecordable(const Aabb& box, bool all_present) {
  return isSound(box) || (!all_present && box == kEmptyBox);
}

inline float squaredLength(const Quaternion& q) {
  return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
}

inline bool isSound(const Pose& pose) {
  constexpr float kHuge = std::numeric_limits<float>::max();
  bool sound = std::abs(squaredLength(pose.rotation) - 1) <= kRotationTolerance;
  for (const float coordinate : pose.position) sound &= std::abs(coordinate) <= kHuge;
  return sound;
}

/// Throws InputError with the first record for which isSound() is false. `first` is the index of
/// the first of these records in the set.
template <class Record>
void requireValid(std::span<const Record> records, std::uint64_t set, const SceneInfo& scene,
                  const std::string& name, std::string_view what, std::size_t first = 0) {
  bool sound = true;
  for (const Record& record : records) sound &= isSound(record);
  if (sound) return;
  const auto broken =
      std::ranges::find_if_not(records, [](const Record& record) { return isSound(record); });
  const auto body = first + static_cast<std::uint64_t>(broken - records.begin());
  throw InputError(fmt::format("{}: frame {}, body {} (byte {}): the {} {}", name, set, body,
                               setOffset(scene, set) + body * kRecordBytes, what, fault(*broken)));
}

/// A recording being written: hashed incrementally, visible only after finish(). A large block is
/// hashed and written while the caller prepares the next one.
class RecordingFile {
 public:
  /// Writes to `path`, or if it is empty to an unnamed file in the temporary directory; starts
  /// with `header`. Throws InputError if the path cannot be written.
  RecordingFile(const std::filesystem::path& path, const SceneInfo&, std::vector<std::byte> header);
  RecordingFile(const RecordingFile&) = delete;  // the writing thread refers to this
  RecordingFile& operator=(const RecordingFile&) = delete;
  virtual ~RecordingFile() = default;

  /// Appends the boxes of the next frame, regardless of its index. Throws InputError for an invalid
  /// box, or if the disk was full, at the latest in finish().
  virtual void write(const Frame&) = 0;
  /// Completes the recording and renames the file. Returns its hash.
  std::string finish();
  /// Completes the recording and returns the unnamed file.
  FileDescriptor finishTemporary();
  [[nodiscard]] const SceneInfo& scene() const { return scene_; }
  [[nodiscard]] const std::string& name() const { return name_; }

 protected:
  /// Appends a block, and swaps it for another buffer.
  void append(std::vector<std::byte>& block);
  /// Bytes appended so far.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Checks that all frames were written, and appends the trailer.
  virtual void complete() = 0;
  /// Throws std::logic_error unless `sets` is the scene's number of frames.
  void requireComplete(std::uint64_t sets) const;
  /// Throws std::logic_error unless `bodies` is the scene's number of bodies.
  void requireBodies(std::size_t bodies) const;

 private:
  /// Waits for the last write. Throws InputError if it failed.
  void waitForWrite();
  void store(std::span<const std::byte> bytes);

  SceneInfo scene_;
  std::string name_;
  std::unique_ptr<AtomicFile> named_;
  FileDescriptor unnamed_;
  Hasher hasher_;
  std::uint64_t size_ = 0;
  std::vector<std::byte> writing_block_;  ///< the last block, possibly being written
  std::future<void> writing_;             ///< last member: its thread uses all of the above
};

/// A .broadmark recording.
std::unique_ptr<RecordingFile> makeRecording2File(const std::filesystem::path& path,
                                                  const SceneInfo&, const RecordingOrigin&);

/// A recording in the original's format: .aabbs, or .posrot by append().
class OriginalRecordingFile final : public RecordingFile {
 public:
  /// Throws InputError for an invalid scene (names, counts) or if the path cannot be written.
  OriginalRecordingFile(const std::filesystem::path& path, const SceneInfo& scene);

  void write(const Frame& frame) override { append(frame.boxes, "box"); }

  /// Appends a set. Throws InputError if a record is invalid.
  template <class Record>
  void append(std::span<const Record> records, std::string_view what) {
    append(records, what, std::as_bytes(records));
  }
  /// Appends a set of records with a different layout in the file.
  template <class Record>
  void append(std::span<const Record> records, std::string_view what,
              std::span<const std::byte> bytes) {
    requireBodies(bytes.size() / kRecordBytes);
    set_.resize(bytes.size());
    // In blocks, so that checked data are still in the cache when copied.
    constexpr std::size_t kPiece = 1 << 13;
    for (std::size_t first = 0; first < records.size(); first += kPiece) {
      const auto piece = records.subspan(first, std::min(kPiece, records.size() - first));
      requireValid(piece, sets_, scene(), name(), what, first);
      std::ranges::copy(bytes.subspan(first * kRecordBytes, piece.size() * kRecordBytes),
                        set_.begin() + static_cast<std::ptrdiff_t>(first * kRecordBytes));
    }
    RecordingFile::append(set_);
    ++sets_;
  }

 private:
  void complete() override { requireComplete(sets_); }

  std::uint64_t sets_ = 0;
  std::vector<std::byte> set_;  ///< the set being assembled
};

}  // namespace broadmark
