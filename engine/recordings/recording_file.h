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
void requireSound(std::span<const Record> records, std::uint64_t set, const SceneInfo& scene,
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

/// A file while it is written: hashed as it grows, there only after finish(). A large block is
/// hashed and written while the caller makes the next one.
class GrowingFile {
 public:
  /// Throws InputError if the path cannot be written.
  explicit GrowingFile(const std::filesystem::path& path)
      : name_(path.string()), named_(std::make_unique<AtomicFile>(path)) {}
  /// An unnamed file in the temporary directory; `name` stands for it in messages.
  explicit GrowingFile(std::string name) : name_(std::move(name)), unnamed_(unnamedFile()) {}
  GrowingFile(const GrowingFile&) = delete;  // a block on its way refers to this
  GrowingFile& operator=(const GrowingFile&) = delete;

  /// Appends a block, which is swapped for another buffer. Throws InputError when the disc was
  /// full, at the latest in finish().
  void append(std::vector<std::byte>& block);
  /// Gives the file its name. Returns its hash.
  std::string finish();
  /// Hands over the unnamed file.
  FileDescriptor finishTemporary();
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  /// Waits until the last block is written. Throws InputError when that failed.
  void settle();
  void write(std::span<const std::byte> bytes);

  std::string name_;
  std::unique_ptr<AtomicFile> named_;
  FileDescriptor unnamed_;
  Hasher hasher_;
  std::vector<std::byte> handed_;  ///< the last block, perhaps being written
  std::future<void> writing_;      ///< last: its thread uses all of the above
};

/// Writes to `path`, or for an empty one to an unnamed file.
std::unique_ptr<GrowingFile> growingFile(const std::filesystem::path& path, const SceneInfo&);

/// A recording of boxes while it is written; see RecordingWriter.
class BoxRecordingFile {
 public:
  virtual ~BoxRecordingFile() = default;

  /// The next frame, whatever its index.
  virtual void write(const Frame&) = 0;
  virtual std::string finish() = 0;
  virtual std::unique_ptr<Recording> finishTemporary() = 0;
};

/// A .broadmark recording; `path` may be empty: then it is a temporary one.
std::unique_ptr<BoxRecordingFile> makeRecording2File(const std::filesystem::path& path,
                                                     const SceneInfo&, const RecordingOrigin&);

/// Throws std::logic_error unless as many sets as the scene has frames were written.
void requireWhole(std::uint64_t sets, const SceneInfo&, const std::string& name);
/// Throws std::logic_error unless a set has as many bodies as the scene.
void requireBodies(std::size_t bodies, const SceneInfo&, const std::string& name);

/// A recording laid out as the original's while it is written.
class RecordingFile {
 public:
  /// Throws InputError if the scene cannot be recorded (names, counts) or the path not be written.
  /// Without a path: to an unnamed file.
  RecordingFile(const std::filesystem::path& path, const SceneInfo& scene);

  /// Appends a set. Throws InputError when one of its records is broken, and then it is not
  /// written, or when the disc was full, at the latest in finish().
  template <class Record>
  void append(std::span<const Record> records, std::string_view what) {
    append(records, what, std::as_bytes(records));
  }
  /// The same for records that lie differently in the file.
  template <class Record>
  void append(std::span<const Record> records, std::string_view what,
              std::span<const std::byte> bytes) {
    requireBodies(bytes.size() / kRecordBytes, scene_, name());
    filling_.resize(bytes.size());
    // In pieces, so that what was checked is still in the cache when it is copied.
    constexpr std::size_t kPiece = 1 << 13;
    for (std::size_t first = 0; first < records.size(); first += kPiece) {
      const auto piece = records.subspan(first, std::min(kPiece, records.size() - first));
      requireSound(piece, sets_, scene_, name(), what, first);
      std::ranges::copy(bytes.subspan(first * kRecordBytes, piece.size() * kRecordBytes),
                        filling_.begin() + static_cast<std::ptrdiff_t>(first * kRecordBytes));
    }
    file_->append(filling_);
    ++sets_;
  }

  /// Gives the file its name, once all sets are written. Returns the hash.
  std::string finish();
  /// Hands over the unnamed file, once all sets are written.
  FileDescriptor finishTemporary();
  [[nodiscard]] const std::string& name() const { return file_->name(); }

 private:
  SceneInfo scene_;
  std::unique_ptr<GrowingFile> file_;
  std::uint64_t sets_ = 0;
  std::vector<std::byte> filling_;  ///< the set that is being appended
};

}  // namespace broadmark
