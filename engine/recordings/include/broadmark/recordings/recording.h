// Recordings: reading and writing.
//
// Those of the original Broadmark, byte for byte. Little-endian: name char[128], object type
// char[128] (NUL-padded printable ASCII), int32 objects, int32 frames, int32 0, int32 0, the world
// box, then 1 + frames sets of 32 bytes per body. In an .aabbs recording all sets are boxes;
// .posrot recordings are in posrot.h. What these cannot hold, absent bodies and a collision filter,
// a .broadmark recording can: recording2.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/files.h"
#include "broadmark/frame.h"
#include "broadmark/large_array.h"

namespace broadmark {

inline constexpr std::size_t kRecordingHeaderBytes = 304;
inline constexpr std::string_view kAabbsExtension = ".aabbs";
inline constexpr std::string_view kPosrotExtension = ".posrot";
inline constexpr std::string_view kBroadmarkExtension = ".broadmark";

/// Of all kinds of recordings, for help and messages.
std::vector<std::string> recordingExtensions();
/// Of those that hold boxes: what a RecordingWriter writes.
std::vector<std::string> boxRecordingExtensions();

/// Whether an .aabbs recording can hold the scene: nobody is ever absent, and all pairs are wanted.
bool fitsAabbs(const SceneInfo&);
/// Of the recording that a scene gets where nobody asks for another: .aabbs if that can hold it,
/// else .broadmark.
std::string_view recordingExtension(const SceneInfo&);

/// Throws InputError unless a recording of this name can hold the scene.
void requireHolds(const std::filesystem::path& path, const SceneInfo&);

/// Size of a whole .aabbs or .posrot recording: 304 + 32·objects·(1 + frames); the largest uint64
/// if that is larger. A .broadmark recording is smaller, but for its header.
std::uint64_t recordingBytes(const SceneInfo&);

/// "FreeFall Cubes N1000 F1000frames.aabbs"
std::string recordingFileName(const SceneInfo&, std::string_view extension);
/// The same with recordingExtension().
std::string recordingFileName(const SceneInfo&);

/// What a recording can say of where it comes from. Only .broadmark recordings can.
struct RecordingOrigin {
  std::string source;            ///< what it was made from, if that was a file
  std::string scene_parameters;  ///< a JSON object, as in the sidecar of a baked one; "": unknown

  friend bool operator==(const RecordingOrigin&, const RecordingOrigin&) = default;
};

/// A recording of any kind and length, read with the memory of one frame. Every frame is checked as
/// it is read. All errors are InputErrors that name the file and the byte offset, or frame and
/// body.
class Recording : public IndexedFrames {
 public:
  [[nodiscard]] const SceneInfo& scene() const final { return scene_; }

  /// XXH3-128 of the whole file as 32 hex digits; reads it through on first use.
  const std::string& hash();

  /// The path, or what stands for it in messages.
  [[nodiscard]] const std::string& name() const final { return name_; }

  [[nodiscard]] virtual const RecordingOrigin& origin() const;

  /// Of the whole file.
  [[nodiscard]] std::uint64_t bytes() const { return size_; }

 protected:
  Recording(FileDescriptor file, std::string name);

  /// To be called once: what the header says.
  void setScene(SceneInfo scene) { scene_ = std::move(scene); }
  /// Reads exactly `bytes.size()` bytes, all of them from the file as it was opened.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  /// Throws InputError when somebody has written into the open file: what was read before and after
  /// would not go together. (A file that has taken its name is another one, and disturbs nobody.)
  void requireUnchanged() const;

  std::string name_;
  FileDescriptor file_;
  std::uint64_t size_ = 0;
  timespec written_{};  ///< when it was written to last
  SceneInfo scene_;
  std::string hash_;
};

/// A recording laid out as the original's: .aabbs or .posrot.
class OriginalRecording : public Recording {
 protected:
  /// Checks the header and the length of an open file.
  OriginalRecording(FileDescriptor file, std::string name);

  /// Reads set `index`, which holds `bytes.size()` bytes.
  void readSet(std::uint32_t index, std::span<std::byte> bytes) const;
};

/// Opens a recording of the kind that the path's extension names; without one of ours, .aabbs.
std::unique_ptr<Recording> openRecordingFile(const std::filesystem::path& path);

/// Reads an .aabbs recording.
class RecordingReader final : public OriginalRecording {
 public:
  explicit RecordingReader(const std::filesystem::path& path);
  /// The same from an open descriptor, which this takes over; `name` stands for it in messages.
  RecordingReader(FileDescriptor file, std::string name);

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;

  LargeVector<Aabb> boxes_;
};

class RecordingFile;  // a recording of some kind while it is written

/// Writes a recording of boxes, frame by frame, to a temporary neighbour of `path` that takes its
/// name only in finish(): a writer that is destroyed or killed before leaves nothing that looks
/// whole. The path's extension names the kind; without one of ours it is .aabbs.
class RecordingWriter {
 public:
  /// Throws InputError if the scene cannot be recorded (names, counts, or .aabbs cannot hold it) or
  /// the path not be written.
  RecordingWriter(const std::filesystem::path& path, const SceneInfo& scene,
                  const RecordingOrigin& origin = {});
  /// Writes to an unnamed file in the temporary directory instead, of the kind that
  /// recordingExtension() names; see finishTemporary().
  explicit RecordingWriter(const SceneInfo& scene);
  ~RecordingWriter();

  /// Appends one set of boxes; the first is the initial pose. Throws InputError when a box is not
  /// finite or inverted (a simulation that blew up) and not that of a body that may be absent, or
  /// the disc is full.
  void write(std::span<const Aabb> boxes);
  /// The same for the next frame of a source, all of whose frames are written. If it says what
  /// changed, a .broadmark recording looks at nothing else.
  void write(const Frame& frame);
  /// Completes the recording and gives it its name. Exactly 1 + frames sets must be written.
  /// Returns the recording's hash, as Recording::hash().
  std::string finish();
  /// The same for an unnamed recording: a reader of it. It vanishes with the reader.
  std::unique_ptr<Recording> finishTemporary();

 private:
  std::unique_ptr<RecordingFile> file_;
};

/// Told after each frame; returning false stops.
using FrameProgress = std::function<bool(std::uint32_t frame)>;
/// Takes down one frame.
using FrameSink = std::function<void(const Frame&)>;

/// Hands all frames of `source`, from its initial pose on, to `sink`. Returns false when `progress`
/// stopped it.
bool recordAll(FrameSource& source, const FrameSink& sink, const FrameProgress& progress = {});
/// The same into a recording, which is not whole when stopped.
bool recordAll(FrameSource& source, RecordingWriter& writer, const FrameProgress& progress = {});

}  // namespace broadmark
