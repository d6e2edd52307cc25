// Recordings: reading and writing, byte for byte as the original Broadmark's.
//
// Little-endian: name char[128], object type char[128] (NUL-padded printable ASCII), int32 objects,
// int32 frames, int32 0, int32 0, the world box, then 1 + frames sets of 32 bytes per body. In an
// .aabbs recording all sets are boxes; .posrot recordings are in posrot.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/files.h"
#include "broadmark/frame.h"

namespace broadmark {

inline constexpr std::size_t kRecordingHeaderBytes = 304;
inline constexpr std::string_view kAabbsExtension = ".aabbs";
inline constexpr std::string_view kPosrotExtension = ".posrot";

/// Size of a whole recording of either kind: 304 + 32·objects·(1 + frames); the largest uint64 if
/// that is larger.
std::uint64_t recordingBytes(const SceneInfo&);

/// "FreeFall Cubes N1000 F1000frames.aabbs"
std::string recordingFileName(const SceneInfo&, std::string_view extension = kAabbsExtension);

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

 protected:
  /// Checks the header and the length of an open file.
  Recording(FileDescriptor file, std::string name);

  /// Reads set `index`, which holds `bytes.size()` bytes.
  void readSet(std::uint32_t index, std::span<std::byte> bytes) const;

 private:
  std::string name_;
  FileDescriptor file_;
  SceneInfo scene_;
  std::string hash_;
};

/// Opens a recording of the kind that the path's extension names; without one of ours, .aabbs.
std::unique_ptr<Recording> openRecordingFile(const std::filesystem::path& path);

/// Reads an .aabbs recording.
class RecordingReader final : public Recording {
 public:
  explicit RecordingReader(const std::filesystem::path& path);
  /// The same from an open descriptor, which this takes over; `name` stands for it in messages.
  RecordingReader(FileDescriptor file, std::string name);

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;

  std::vector<Aabb> boxes_;
};

class RecordingFile;  // shared by the writers of all kinds of recordings

/// Writes an .aabbs recording, frame by frame, to a temporary neighbour of `path` that takes its
/// name only in finish(): a writer that is destroyed or killed before leaves nothing that looks
/// whole.
class RecordingWriter {
 public:
  /// Throws InputError if the scene cannot be recorded (names, counts) or the path not be written.
  RecordingWriter(const std::filesystem::path& path, const SceneInfo& scene);
  /// Writes to an unnamed file in the temporary directory instead; see finishTemporary().
  explicit RecordingWriter(const SceneInfo& scene);
  ~RecordingWriter();

  /// Appends one set of boxes; the first is the initial pose. Throws InputError when a box is not
  /// finite or inverted (a simulation that blew up), or the disc is full.
  void write(std::span<const Aabb> boxes);
  /// Completes the recording and gives it its name. Exactly 1 + frames sets must be written.
  /// Returns the recording's hash, as Recording::hash().
  std::string finish();
  /// The same for an unnamed recording: a reader of it. It vanishes with the reader.
  std::unique_ptr<RecordingReader> finishTemporary();

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
