// Reading recordings of any kind, and .aabbs recordings.

#include "broadmark/recording.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>

#include "broadmark/error.h"
#include "broadmark/posrot.h"
#include "recording_file.h"

namespace broadmark {
namespace {

/// Reads exactly `bytes`, from `offset`.
void readAll(int fd, std::span<std::byte> bytes, std::uint64_t offset, const std::string& name) {
  while (!bytes.empty()) {
    const ssize_t got = ::pread(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      throw InputError(
          fmt::format("{}: cannot read at byte {}: {}", name, offset, std::strerror(errno)));
    }
    if (got == 0) throw InputError(fmt::format("{}: ends at byte {}", name, offset));
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
}

}  // namespace

std::uint64_t recordingBytes(const SceneInfo& scene) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t boxes = std::uint64_t{scene.objects} * (std::uint64_t{1} + scene.frames);
  // Absurd counts must not wrap around to a size that looks right.
  if (boxes > (kMost - kRecordingHeaderBytes) / kRecordBytes) return kMost;
  return kRecordingHeaderBytes + kRecordBytes * boxes;
}

std::string recordingFileName(const SceneInfo& scene, std::string_view extension) {
  return fmt::format("{} {} N{} F{}frames{}", scene.name, scene.object_type, scene.objects,
                     scene.frames, extension);
}

Recording::Recording(FileDescriptor file, std::string name)
    : name_(std::move(name)), file_(std::move(file)) {
  struct stat status {};
  if (::fstat(file_.get(), &status) != 0) {
    throw InputError(fmt::format("{}: cannot read: {}", name_, std::strerror(errno)));
  }
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size < kRecordingHeaderBytes) {
    throw InputError(fmt::format("{}: {} bytes is too short: a recording has a header of {} bytes",
                                 name_, size, kRecordingHeaderBytes));
  }
  RecordingHeader header{};
  readAll(file_.get(), std::as_writable_bytes(std::span(&header, 1)), 0, name_);
  scene_ = parseHeader(header, name_);
  const std::uint64_t expected = recordingBytes(scene_);
  if (size != expected) {
    throw InputError(fmt::format(
        "{}: {} bytes is too {}: {} objects and {} frames take 304 + 32·{}·(1 + {}) = {} bytes",
        name_, size, size < expected ? "short" : "long", scene_.objects, scene_.frames,
        scene_.objects, scene_.frames, expected));
  }
}

void Recording::readSet(std::uint32_t index, std::span<std::byte> bytes) const {
  readAll(file_.get(), bytes, setOffset(scene_, index), name_);
}

const std::string& Recording::hash() {
  if (!hash_.empty()) return hash_;
  Hasher hasher;
  std::vector<std::byte> chunk(1 << 20);
  const std::uint64_t size = recordingBytes(scene_);
  for (std::uint64_t offset = 0; offset < size; offset += chunk.size()) {
    const std::span part(chunk.data(), std::min<std::uint64_t>(chunk.size(), size - offset));
    readAll(file_.get(), part, offset, name_);
    hasher.add(part);
  }
  return hash_ = hasher.hex();
}

std::unique_ptr<Recording> openRecordingFile(const std::filesystem::path& path) {
  if (path.extension() == kPosrotExtension) return std::make_unique<PosrotReader>(path);
  return std::make_unique<RecordingReader>(path);
}

RecordingReader::RecordingReader(const std::filesystem::path& path)
    : RecordingReader(openForReading(path), path.string()) {}

RecordingReader::RecordingReader(FileDescriptor file, std::string name)
    : Recording(std::move(file), std::move(name)), boxes_(scene().objects) {}

std::span<const Aabb> RecordingReader::readBoxes(std::uint32_t index) {
  readSet(index, std::as_writable_bytes(std::span(boxes_)));
  requireSound<Aabb>(boxes_, index, scene(), name(), "box");
  return boxes_;
}

RecordingWriter::RecordingWriter(const std::filesystem::path& path, const SceneInfo& scene)
    : file_(std::make_unique<RecordingFile>(path, scene)) {}

RecordingWriter::RecordingWriter(const SceneInfo& scene)
    : file_(std::make_unique<RecordingFile>(scene)) {}

RecordingWriter::~RecordingWriter() = default;

void RecordingWriter::write(std::span<const Aabb> boxes) { file_->append(boxes, "box"); }

std::string RecordingWriter::finish() { return file_->finish(); }

std::unique_ptr<RecordingReader> RecordingWriter::finishTemporary() {
  return std::make_unique<RecordingReader>(file_->finishTemporary(), file_->name());
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
  return recordAll(
      source, [&](const Frame& frame) { writer.write(frame.boxes); }, progress);
}

}  // namespace broadmark
