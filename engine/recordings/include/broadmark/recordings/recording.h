// Recordings: reading and writing.
//
// Compatible with the original Broadmark's format, byte for byte. Little-endian: name char[128],
// object type char[128] (NUL-padded printable ASCII), int32 objects, int32 frames, int32 0, int32
// 0, the world box, then 1 + frames sets of 32 bytes per body. In an .aabbs recording all sets are
// boxes; for .posrot recordings see posrot.h. Absent bodies and collision filters require a
// .broadmark recording: recording2.h.
//
// Example:
//
//   const auto copy = [](const std::filesystem::path& from, const std::filesystem::path& to) {
//     const std::unique_ptr<Recording> source = openRecordingFile(from);
//     RecordingWriter writer(to, source->scene(), source->origin());
//     recordAll(*source, writer);
//     return writer.finish();  // the hash of the new file
//   };
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

/// Bytes before the first set of an .aabbs or .posrot recording.
inline constexpr std::size_t kRecordingHeaderBytes = 304;
inline constexpr std::string_view kAabbsExtension = ".aabbs";
inline constexpr std::string_view kPosrotExtension = ".posrot";
inline constexpr std::string_view kBroadmarkExtension = ".broadmark";

/// The extensions of all formats, for help and messages.
std::vector<std::string> recordingExtensions();
/// The extensions of the formats with boxes, which RecordingWriter supports.
std::vector<std::string> boxRecordingExtensions();

/// Whether an .aabbs recording can hold the scene: without absent bodies, unwanted pairs, or a
/// periodic world.
bool fitsAabbs(const SceneInfo&);
/// The extension of the scene's default format: .aabbs if possible, else .broadmark.
std::string_view recordingExtension(const SceneInfo&);

/// Throws InputError unless the format of the path's extension can hold the scene. Unknown
/// extensions mean .aabbs.
void requireHolds(const std::filesystem::path& path, const SceneInfo&);

/// Size of a whole .aabbs or .posrot recording in bytes: 304 + 32·objects·(1 + frames); the largest
/// uint64 if the size exceeds it. A .broadmark recording is smaller except for its header.
std::uint64_t recordingBytes(const SceneInfo&);

/// "FreeFall Cubes N1000 F1000frames.aabbs"; `extension` begins with a dot.
std::string recordingFileName(const SceneInfo&, std::string_view extension);
/// The file name with recordingExtension().
std::string recordingFileName(const SceneInfo&);

/// Provenance of a recording. Stored only in .broadmark recordings.
struct RecordingOrigin {
  std::string source;            ///< the source file, if any
  std::string scene_parameters;  ///< a JSON object, as in a baked recording's sidecar; "": unknown
  std::string import = {};       ///< what was understood of imported files; "": not imported

  friend bool operator==(const RecordingOrigin&, const RecordingOrigin&) = default;
};

/// A recording of any format and length; memory is that of one frame, and for a .broadmark
/// recording 32 bytes per frame. Every frame is validated when read. All errors are InputErrors
/// with the file and the byte offset, or frame and body. Reading fails once the open file has been
/// modified.
///
/// Frames have the boxes of the file: in a periodic world only adapted() (adapted_frames.h) wraps
/// them.
class Recording : public IndexedFrames {
 public:
  [[nodiscard]] const SceneInfo& scene() const final { return scene_; }

  /// XXH3-128 of the whole file as 32 hex digits; computed on first use, by reading the file.
  /// Throws Cancelled soon after `cancelled` returns true, and InputError.
  const std::string& hash(const std::function<bool()>& cancelled = {});

  /// The path, or a substitute for messages.
  [[nodiscard]] const std::string& name() const final { return name_; }

  /// Empty texts unless the file states them.
  [[nodiscard]] virtual const RecordingOrigin& origin() const;

  /// The size of the file.
  [[nodiscard]] std::uint64_t bytes() const { return size_; }

 protected:
  /// Takes ownership of an open file; `name` is used in messages.
  Recording(FileDescriptor file, std::string name);

  /// Must be called once, with the header's contents.
  void setScene(SceneInfo scene) { scene_ = std::move(scene); }
  /// Reads exactly `bytes.size()` bytes. Throws if the file was modified since opening.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  /// Throws InputError if the open file was modified, which would make reads inconsistent. (Another
  /// file renamed to the same path is harmless.)
  void requireUnchanged() const;

  std::string name_;
  FileDescriptor file_;
  std::uint64_t size_ = 0;
  timespec written_{};  ///< last modification
  SceneInfo scene_;
  std::string hash_;
};

/// A recording in the original's format: .aabbs or .posrot.
class OriginalRecording : public Recording {
 protected:
  /// Validates the header and the length of an open file. Throws InputError.
  OriginalRecording(FileDescriptor file, std::string name);

  /// Reads set `index` of `bytes.size()` bytes.
  void readSet(std::uint32_t index, std::span<std::byte> bytes) const;
};

/// Opens a recording in the format of the path's extension; unknown extensions mean .aabbs. Reads
/// and validates the header, and the index of a .broadmark recording. Throws InputError.
std::unique_ptr<Recording> openRecordingFile(const std::filesystem::path& path);

/// Reads an .aabbs recording. Each at() reads the file: 32 bytes per body.
class RecordingReader final : public OriginalRecording {
 public:
  /// Opens a file, whatever its extension. Throws InputError, as does the other constructor.
  explicit RecordingReader(const std::filesystem::path& path);
  /// Reads from an open descriptor, and takes ownership of it; `name` is used in messages.
  RecordingReader(FileDescriptor file, std::string name);

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;

  LargeVector<Aabb> boxes_;
};

class RecordingFile;  // a recording of some format being written

/// Writes a recording of boxes, frame by frame, to a temporary file beside `path` that finish()
/// renames: a writer destroyed or killed earlier leaves no file that appears complete. The format
/// is that of the path's extension; unknown extensions mean .aabbs. Memory is that of up to three
/// frames, and for a .broadmark recording 36 bytes per frame. Another thread hashes and writes a
/// large frame while the caller prepares the next one.
class RecordingWriter {
 public:
  /// Throws InputError for an invalid scene (names, counts, or unsupported by .aabbs), for a
  /// .posrot path, or if the path cannot be written.
  RecordingWriter(const std::filesystem::path& path, const SceneInfo& scene,
                  const RecordingOrigin& origin = {});
  /// Writes to an unnamed file in the temporary directory instead, in the format of
  /// recordingExtension(); see finishTemporary(). Throws InputError.
  explicit RecordingWriter(const SceneInfo& scene);
  ~RecordingWriter();

  /// Appends a set of boxes under the scene's filter, one per body by id; the first is the initial
  /// pose. Throws InputError if a box is not finite or inverted (a simulation that blew up), except
  /// for absent bodies, or if the disk is full, possibly in a later call. Throws std::logic_error
  /// for another number of boxes.
  void write(std::span<const Aabb> boxes);
  /// Appends the next frame of a source, all frames of which must be written; Frame::index is
  /// ignored. With Frame::changed, the writer of a .broadmark recording reads only the changed
  /// boxes except in key frames: then every frame must come by this function, as changes between a
  /// listed frame and a plain set would be lost. Throws as above; the writer of a .broadmark
  /// recording also std::logic_error for a filter that the scene does not announce.
  void write(const Frame& frame);
  /// Completes a recording with a path and renames it to that path, replacing any file there.
  /// Returns the recording's hash, as Recording::hash(). Throws std::logic_error unless exactly
  /// 1 + frames sets were written, and InputError. At most one call, the last one of the writer.
  std::string finish();
  /// Completes an unnamed recording and returns a reader; otherwise as finish(). The file is
  /// deleted with the reader.
  std::unique_ptr<Recording> finishTemporary();

 private:
  std::unique_ptr<RecordingFile> file_;
};

/// Called after each frame, the initial pose included, with its index; returns false to stop.
using FrameProgress = std::function<bool(std::uint32_t frame)>;
/// Called with each frame, which is valid during the call.
using FrameSink = std::function<void(const Frame&)>;

/// Passes all frames of `source`, from its initial pose on, to `sink`. Returns false when
/// `progress` stopped it, even after the last frame. Throws as source and sink.
bool recordAll(FrameSource& source, const FrameSink& sink, const FrameProgress& progress = {});
/// Writes all frames to a recording, which remains incomplete if stopped; else the caller finishes
/// it.
bool recordAll(FrameSource& source, RecordingWriter& writer, const FrameProgress& progress = {});

}  // namespace broadmark
