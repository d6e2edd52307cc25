// What recordings share: the checks, and the file being written; and the header of the original's.
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

/// Bytes that a box or a pose takes in a set.
inline constexpr std::size_t kRecordBytes = 32;

/// The header as it lies in the file.
struct RecordingHeader {
  char name[128];
  char object_type[128];
  std::int32_t objects;
  std::int32_t frames;
  std::int32_t zero[2];
  Aabb world;
};

/// What a header states. Throws InputError naming `name` and the byte offset of what is wrong.
SceneInfo parseHeader(const RecordingHeader&, const std::string& name);

/// Where set `set` begins.
std::uint64_t setOffset(const SceneInfo&, std::uint64_t set);

/// Throws InputError naming the scene and what of it no recording holds.
void requireNames(const SceneInfo&);
/// Whether a scene or an object type may have this name.
bool isName(std::string_view text);

/// "" or what is wrong with a record.
std::string fault(const Aabb&);
std::string fault(const Pose&);

// The same check without branches, enough for nearly all records. Comparisons with NaN are false.
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

/// Whether a recording 2 may hold it: the same, or that of a body that may be absent.
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

/// Throws InputError naming the first record for which isSound() is false. `first` is the number of
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

/// A recording while it is written: hashed as it grows, there only after finish(). A large block is
/// hashed and written while the caller makes the next one.
class RecordingFile {
 public:
  /// Writes to `path`, or for an empty one to an unnamed file in the temporary directory; `header`
  /// comes first. Throws InputError if the path cannot be written.
  RecordingFile(const std::filesystem::path& path, const SceneInfo&, std::vector<std::byte> header);
  RecordingFile(const RecordingFile&) = delete;  // a block on its way refers to this
  RecordingFile& operator=(const RecordingFile&) = delete;
  virtual ~RecordingFile() = default;

  /// Appends the boxes of the next frame, whatever its index. Throws InputError when one is broken,
  /// or when the disc was full, at the latest in finish().
  virtual void write(const Frame&) = 0;
  /// Completes the recording and gives the file its name. Returns its hash.
  std::string finish();
  /// Completes the recording and hands over the unnamed file.
  FileDescriptor finishTemporary();
  [[nodiscard]] const SceneInfo& scene() const { return scene_; }
  [[nodiscard]] const std::string& name() const { return name_; }

 protected:
  /// Appends a block, which is swapped for another buffer.
  void append(std::vector<std::byte>& block);
  /// Bytes so far.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Checks that all frames were written, and appends what follows them.
  virtual void complete() = 0;
  /// Throws std::logic_error unless as many sets as the scene has frames were written.
  void requireWhole(std::uint64_t sets) const;
  /// Throws std::logic_error unless a set has as many bodies as the scene.
  void requireBodies(std::size_t bodies) const;

 private:
  /// Waits until the last block is written. Throws InputError when that failed.
  void waitForWrite();
  void store(std::span<const std::byte> bytes);

  SceneInfo scene_;
  std::string name_;
  std::unique_ptr<AtomicFile> named_;
  FileDescriptor unnamed_;
  Hasher hasher_;
  std::uint64_t size_ = 0;
  std::vector<std::byte> handed_;  ///< the last block, perhaps being written
  std::future<void> writing_;      ///< last: its thread uses all of the above
};

/// A .broadmark recording.
std::unique_ptr<RecordingFile> makeRecording2File(const std::filesystem::path& path,
                                                  const SceneInfo&, const RecordingOrigin&);

/// A recording laid out as the original's: .aabbs, or .posrot by append().
class OriginalRecordingFile final : public RecordingFile {
 public:
  /// Throws InputError if the scene cannot be recorded (names, counts) or the path not be written.
  OriginalRecordingFile(const std::filesystem::path& path, const SceneInfo& scene);

  void write(const Frame& frame) override { append(frame.boxes, "box"); }

  /// Appends a set. One with a broken record is not written.
  template <class Record>
  void append(std::span<const Record> records, std::string_view what) {
    append(records, what, std::as_bytes(records));
  }
  /// Appends a set whose records lie differently in the file.
  template <class Record>
  void append(std::span<const Record> records, std::string_view what,
              std::span<const std::byte> bytes) {
    requireBodies(bytes.size() / kRecordBytes);
    filling_.resize(bytes.size());
    // In pieces, so that what was checked is still in the cache when it is copied.
    constexpr std::size_t kPiece = 1 << 13;
    for (std::size_t first = 0; first < records.size(); first += kPiece) {
      const auto piece = records.subspan(first, std::min(kPiece, records.size() - first));
      requireValid(piece, sets_, scene(), name(), what, first);
      std::ranges::copy(bytes.subspan(first * kRecordBytes, piece.size() * kRecordBytes),
                        filling_.begin() + static_cast<std::ptrdiff_t>(first * kRecordBytes));
    }
    RecordingFile::append(filling_);
    ++sets_;
  }

 private:
  void complete() override { requireWhole(sets_); }

  std::uint64_t sets_ = 0;
  std::vector<std::byte> filling_;  ///< the set that is being appended
};

}  // namespace broadmark
