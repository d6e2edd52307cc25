// The recording formats; reading and writing .aabbs recordings.

#include "broadmark/recordings/recording.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "broadmark/error.h"
#include "broadmark/recordings/posrot.h"
#include "broadmark/recordings/recording2.h"
#include "recording_file.h"

namespace broadmark {
namespace {

std::unique_ptr<RecordingFile> makeAabbsFile(const std::filesystem::path& path,
                                             const SceneInfo& scene, const RecordingOrigin&) {
  return std::make_unique<OriginalRecordingFile>(path, scene);
}

template <class Reader>
std::unique_ptr<Recording> open(FileDescriptor file, std::string name) {
  return std::make_unique<Reader>(std::move(file), std::move(name));
}

struct RecordingFormat {
  std::string_view extension;
  std::unique_ptr<Recording> (*open)(FileDescriptor, std::string name);
  /// Null if the format does not hold boxes. An empty path: an unnamed file.
  std::unique_ptr<RecordingFile> (*write)(const std::filesystem::path&, const SceneInfo&,
                                          const RecordingOrigin&);
};

constexpr RecordingFormat kFormats[] = {
    {kAabbsExtension, open<RecordingReader>, makeAabbsFile},
    {kBroadmarkExtension, open<Recording2Reader>, makeRecording2File},
    {kPosrotExtension, open<PosrotReader>, nullptr},
};

/// The format of an extension; the first format if it is unknown.
const RecordingFormat& formatOf(std::string_view extension) {
  const auto* format = std::ranges::find(kFormats, extension, &RecordingFormat::extension);
  return format == std::end(kFormats) ? kFormats[0] : *format;
}

struct stat statusOf(const FileDescriptor& file, const std::string& name) {
  struct stat status{};
  if (::fstat(file.get(), &status) == 0) return status;
  throw InputError(fmt::format("{}: cannot read: {}", name, std::strerror(errno)));
}

}  // namespace

std::uint64_t recordingBytes(const SceneInfo& scene) {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t boxes = std::uint64_t{scene.objects} * (std::uint64_t{1} + scene.frames);
  // Absurd counts must not wrap around to a plausible size.
  if (boxes > (kMax - kRecordingHeaderBytes) / kRecordBytes) return kMax;
  return kRecordingHeaderBytes + kRecordBytes * boxes;
}

std::vector<std::string> recordingExtensions() {
  std::vector<std::string> all;
  for (const RecordingFormat& format : kFormats) all.emplace_back(format.extension);
  return all;
}

std::vector<std::string> boxRecordingExtensions() {
  std::vector<std::string> all;
  for (const RecordingFormat& format : kFormats) {
    if (format.write != nullptr) all.emplace_back(format.extension);
  }
  return all;
}

bool fitsAabbs(const SceneInfo& scene) {
  return scene.all_present && scene.filter.wantsAll() && !scene.filter_changes &&
         !scene.periodic.repeats();
}

std::string_view recordingExtension(const SceneInfo& scene) {
  return fitsAabbs(scene) ? kAabbsExtension : kBroadmarkExtension;
}

void requireHolds(const std::filesystem::path& path, const SceneInfo& scene) {
  const RecordingFormat& format = formatOf(path.extension().string());
  if (format.extension == kBroadmarkExtension || fitsAabbs(scene)) return;
  throw InputError(fmt::format(
      "{}: {} recordings hold no absent bodies, layers, worlds, tags or periodic boxes: {} ones do",
      path.string(), format.extension, kBroadmarkExtension));
}

std::string recordingFileName(const SceneInfo& scene) {
  return recordingFileName(scene, recordingExtension(scene));
}

std::string recordingFileName(const SceneInfo& scene, std::string_view extension) {
  return fmt::format("{} {} N{} F{}frames{}", scene.name, scene.object_type, scene.objects,
                     scene.frames, extension);
}

Recording::Recording(FileDescriptor file, std::string name)
    : name_(std::move(name)), file_(std::move(file)) {
  const struct stat status = statusOf(file_, name_);
  size_ = static_cast<std::uint64_t>(status.st_size);
  written_ = status.st_mtim;
}

void Recording::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  const std::uint64_t end = offset + readAll(file_.get(), bytes, offset);
  if (end < offset + bytes.size()) {
    if (errno == 0) throw InputError(fmt::format("{}: the file ends at byte {}", name_, end));
    throw InputError(
        fmt::format("{}: cannot read at byte {}: {}", name_, end, std::strerror(errno)));
  }
  requireUnchanged();
}

void Recording::requireUnchanged() const {
  const struct stat status = statusOf(file_, name_);
  if (static_cast<std::uint64_t>(status.st_size) == size_ &&
      status.st_mtim.tv_sec == written_.tv_sec && status.st_mtim.tv_nsec == written_.tv_nsec) {
    return;
  }
  throw InputError(fmt::format("{}: was written to while it was read", name_));
}

const RecordingOrigin& Recording::origin() const {
  static const RecordingOrigin unknown;
  return unknown;
}

const std::string& Recording::hash(const std::function<bool()>& cancelled) {
  if (!hash_.empty()) return hash_;
  Hasher hasher;
  constexpr std::uint64_t kMaxAtOnce = 1 << 20;
  std::vector<std::byte> chunk(std::min(size_, kMaxAtOnce));
  for (std::uint64_t offset = 0; offset < size_; offset += chunk.size()) {
    if (cancelled && cancelled()) throw Cancelled();
    const std::span part(chunk.data(), std::min<std::uint64_t>(chunk.size(), size_ - offset));
    read(offset, part);
    hasher.add(part);
  }
  return hash_ = hasher.hex();
}

std::unique_ptr<Recording> openRecordingFile(const std::filesystem::path& path) {
  return formatOf(path.extension().string()).open(openForReading(path), path.string());
}

OriginalRecording::OriginalRecording(FileDescriptor file, std::string name)
    : Recording(std::move(file), std::move(name)) {
  if (bytes() < kRecordingHeaderBytes) {
    throw InputError(fmt::format("{}: {} bytes is too short: a recording has a header of {} bytes",
                                 this->name(), bytes(), kRecordingHeaderBytes));
  }
  RecordingHeader header{};
  read(0, std::as_writable_bytes(std::span(&header, 1)));
  setScene(parseHeader(header, this->name()));
  const std::uint64_t expected = recordingBytes(scene());
  if (bytes() != expected) {
    throw InputError(fmt::format(
        "{}: {} bytes is too {}: {} bodies and {} frames take 304 + 32·{}·(1 + {}) = {} bytes",
        this->name(), bytes(), bytes() < expected ? "short" : "long", scene().objects,
        scene().frames, scene().objects, scene().frames, expected));
  }
}

void OriginalRecording::readSet(std::uint32_t index, std::span<std::byte> bytes) const {
  read(setOffset(scene(), index), bytes);
}

RecordingReader::RecordingReader(const std::filesystem::path& path)
    : RecordingReader(openForReading(path), path.string()) {}

RecordingReader::RecordingReader(FileDescriptor file, std::string name)
    : OriginalRecording(std::move(file), std::move(name)), boxes_(scene().objects) {}

std::span<const Aabb> RecordingReader::readBoxes(std::uint32_t index) {
  readSet(index, std::as_writable_bytes(std::span(boxes_)));
  requireValid<Aabb>(boxes_, index, scene(), name(), "box");
  return boxes_;
}

RecordingWriter::RecordingWriter(const std::filesystem::path& path, const SceneInfo& scene,
                                 const RecordingOrigin& origin) {
  const RecordingFormat& format = formatOf(path.extension().string());
  if (format.write == nullptr) {
    throw InputError(fmt::format("{}: the name of a recording of boxes ends in {}", path.string(),
                                 fmt::join(boxRecordingExtensions(), " or ")));
  }
  requireHolds(path, scene);
  file_ = format.write(path, scene, origin);
}

RecordingWriter::RecordingWriter(const SceneInfo& scene)
    : file_(formatOf(recordingExtension(scene)).write({}, scene, {})) {}

RecordingWriter::~RecordingWriter() = default;

void RecordingWriter::write(std::span<const Aabb> boxes) { file_->write({.boxes = boxes}); }

void RecordingWriter::write(const Frame& frame) { file_->write(frame); }

std::string RecordingWriter::finish() { return file_->finish(); }

std::unique_ptr<Recording> RecordingWriter::finishTemporary() {
  const RecordingFormat& format = formatOf(recordingExtension(file_->scene()));
  return format.open(file_->finishTemporary(), file_->name());
}

bool recordAll(FrameSource& source, const FrameSink& sink, const FrameProgress& progress) {
  std::optional<Frame> frame = source.rewind();
  for (; frame; frame = source.next()) {
    sink(*frame);
    if (progress && !progress(frame->index)) return false;
  }
  return true;
}

bool recordAll(FrameSource& source, RecordingWriter& writer, const FrameProgress& progress) {
  return recordAll(source, [&](const Frame& frame) { writer.write(frame); }, progress);
}

}  // namespace broadmark
