// Reading and writing .aabbs recordings.

#include "broadmark/recording.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "broadmark/error.h"

namespace broadmark {
namespace {

static_assert(std::endian::native == std::endian::little, "recordings are read and written as is");

/// The header as it lies in the file.
struct Header {
  char name[128];
  char object_type[128];
  std::int32_t objects;
  std::int32_t frames;
  std::int32_t zero[2];
  Aabb world;
};
static_assert(sizeof(Header) == kRecordingHeaderBytes);

constexpr std::size_t kTextBytes = 128;

/// Frames of no objects take no bytes, so the file's length does not bound their number.
constexpr std::uint32_t kMostEmptyFrames = 1'000'000;

class Hasher {
 public:
  Hasher() { XXH3_128bits_reset(&state_); }
  void add(std::span<const std::byte> bytes) {
    XXH3_128bits_update(&state_, bytes.data(), bytes.size());
  }
  [[nodiscard]] std::string hex() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(&state_);
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  XXH3_state_t state_{};
};

bool isPrintable(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

std::uint64_t frameOffset(const SceneInfo& scene, std::uint64_t frame) {
  return kRecordingHeaderBytes + sizeof(Aabb) * std::uint64_t{scene.objects} * frame;
}

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

/// "" or what is wrong with a box.
std::string_view boxFault(const Aabb& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const float low = box.min[axis];
    const float high = box.max[axis];
    if (std::isnan(low) || std::isnan(high)) return "is not a number (NaN)";
    if (std::isinf(low) || std::isinf(high)) return "is infinite";
    if (low > high) return "is inverted (min > max)";
  }
  return {};
}

/// The same question, without branches: what nearly all boxes need.
bool isSound(const Aabb& box) {
  constexpr float kHuge = std::numeric_limits<float>::max();
  bool sound = true;
  for (int axis = 0; axis < 3; ++axis) {
    sound &= box.min[axis] <= box.max[axis] && box.min[axis] >= -kHuge && box.max[axis] <= kHuge;
  }
  return sound;
}

/// Throws InputError naming the first broken box of a frame.
void requireSound(std::span<const Aabb> boxes, std::uint64_t frame, const SceneInfo& scene,
                  const std::string& name) {
  const auto broken = std::ranges::find_if_not(boxes, isSound);
  if (broken == boxes.end()) return;
  const auto body = static_cast<std::uint64_t>(broken - boxes.begin());
  throw InputError(fmt::format("{}: frame {}, body {} (byte {}): the box {}", name, frame, body,
                               frameOffset(scene, frame) + body * sizeof(Aabb), boxFault(*broken)));
}

/// A NUL-padded text of the header.
std::string headerText(const char (&field)[kTextBytes], std::string_view what, std::size_t offset,
                       const std::string& name) {
  const auto* end = std::find(std::begin(field), std::end(field), '\0');
  const std::string text(std::begin(field), end);
  if (end == std::end(field) || !isPrintable(text)) {
    throw InputError(
        fmt::format("{}: byte {}: the {} is not printable ASCII ended by a NUL: not an .aabbs "
                    "recording?",
                    name, offset, what));
  }
  return text;
}

std::uint32_t headerCount(std::int32_t value, std::string_view what, std::size_t offset,
                          const std::string& name) {
  if (value < 0) {
    throw InputError(
        fmt::format("{}: byte {}: negative number of {} ({})", name, offset, what, value));
  }
  return static_cast<std::uint32_t>(value);
}

SceneInfo parseHeader(const Header& header, const std::string& name) {
  SceneInfo scene;
  scene.name = headerText(header.name, "scene name", offsetof(Header, name), name);
  scene.object_type =
      headerText(header.object_type, "object type", offsetof(Header, object_type), name);
  scene.objects = headerCount(header.objects, "objects", offsetof(Header, objects), name);
  scene.frames = headerCount(header.frames, "frames", offsetof(Header, frames), name);
  if (scene.objects == 0 && scene.frames > kMostEmptyFrames) {
    throw InputError(fmt::format("{}: byte {}: {} frames of no objects: at most {} are allowed",
                                 name, offsetof(Header, frames), scene.frames, kMostEmptyFrames));
  }
  scene.world = header.world;
  if (const std::string_view fault = boxFault(scene.world); !fault.empty()) {
    throw InputError(
        fmt::format("{}: byte {}: the world box {}", name, offsetof(Header, world), fault));
  }
  return scene;
}

void copyText(char (&field)[kTextBytes], const std::string& text, std::string_view what) {
  if (text.size() >= kTextBytes || !isPrintable(text)) {
    throw InputError(
        fmt::format("cannot record the {} '{}': at most 127 printable ASCII characters are allowed",
                    what, text));
  }
  std::ranges::copy(text, field);
}

Header makeHeader(const SceneInfo& scene) {
  constexpr auto kMost = static_cast<std::uint32_t>(std::numeric_limits<std::int32_t>::max());
  if (scene.objects > kMost || scene.frames > kMost) {
    throw InputError(fmt::format("cannot record {} objects and {} frames: at most {} each",
                                 scene.objects, scene.frames, kMost));
  }
  if (scene.objects == 0 && scene.frames > kMostEmptyFrames) {
    throw InputError(fmt::format("cannot record {} frames of no objects: at most {} are allowed",
                                 scene.frames, kMostEmptyFrames));
  }
  Header header{};
  copyText(header.name, scene.name, "scene name");
  copyText(header.object_type, scene.object_type, "object type");
  header.objects = static_cast<std::int32_t>(scene.objects);
  header.frames = static_cast<std::int32_t>(scene.frames);
  header.world = scene.world;
  return header;
}

/// An unnamed file in the temporary directory; it vanishes with its descriptor.
FileDescriptor unnamedFile(const std::filesystem::path& directory) {
  std::string name = (directory / "broadmark-XXXXXX").string();
  FileDescriptor file(::mkstemp(name.data()));
  if (file.get() < 0) {
    throw InputError(
        fmt::format("{}: cannot write a temporary recording: {} (TMPDIR names the "
                    "directory)",
                    directory.string(), std::strerror(errno)));
  }
  ::unlink(name.c_str());
  return file;
}

}  // namespace

std::uint64_t recordingBytes(const SceneInfo& scene) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t boxes = std::uint64_t{scene.objects} * (std::uint64_t{1} + scene.frames);
  // Absurd counts must not wrap around to a size that looks right.
  if (boxes > (kMost - kRecordingHeaderBytes) / sizeof(Aabb)) return kMost;
  return kRecordingHeaderBytes + sizeof(Aabb) * boxes;
}

std::string recordingFileName(const SceneInfo& scene, std::string_view extension) {
  return fmt::format("{} {} N{} F{}frames{}", scene.name, scene.object_type, scene.objects,
                     scene.frames, extension);
}

RecordingReader::RecordingReader(const std::filesystem::path& path)
    : RecordingReader(openForReading(path), path.string()) {}

RecordingReader::RecordingReader(FileDescriptor file, std::string name)
    : name_(std::move(name)), file_(std::move(file)) {
  struct stat status {};
  if (::fstat(file_.get(), &status) != 0) {
    throw InputError(fmt::format("{}: cannot read: {}", name_, std::strerror(errno)));
  }
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size < kRecordingHeaderBytes) {
    throw InputError(
        fmt::format("{}: {} bytes is too short: an .aabbs recording has a header of "
                    "{} bytes",
                    name_, size, kRecordingHeaderBytes));
  }
  Header header{};
  readAll(file_.get(), std::as_writable_bytes(std::span(&header, 1)), 0, name_);
  scene_ = parseHeader(header, name_);
  const std::uint64_t expected = recordingBytes(scene_);
  if (size != expected) {
    throw InputError(fmt::format(
        "{}: {} bytes is too {}: {} objects and {} frames take 304 + 32·{}·(1 + {}) = {} bytes",
        name_, size, size < expected ? "short" : "long", scene_.objects, scene_.frames,
        scene_.objects, scene_.frames, expected));
  }
  boxes_.resize(scene_.objects);
}

std::optional<Frame> RecordingReader::next() {
  if (position_ >= scene_.frames) return std::nullopt;
  return read(position_ + 1);
}

Frame RecordingReader::read(std::uint32_t index) {
  if (index > scene_.frames) {
    throw InputError(
        fmt::format("{}: no frame {}: the last one is {}", name_, index, scene_.frames));
  }
  const std::uint64_t offset = frameOffset(scene_, index);
  readAll(file_.get(), std::as_writable_bytes(std::span(boxes_)), offset, name_);
  requireSound(boxes_, index, scene_, name_);
  position_ = index;
  return {index, boxes_};
}

const std::string& RecordingReader::hash() {
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

struct RecordingWriter::State {
  SceneInfo scene;
  std::string name;
  std::unique_ptr<AtomicFile> named;
  FileDescriptor unnamed;
  Hasher hasher;
  std::uint64_t sets = 0;

  void append(std::span<const std::byte> bytes) {
    hasher.add(bytes);
    if (named) {
      named->write(bytes);
    } else {
      writeAll(unnamed.get(), bytes, name);
    }
  }

  void requireWhole() const {
    if (sets != std::uint64_t{1} + scene.frames) {
      throw std::logic_error(
          fmt::format("{}: {} sets of boxes written instead of 1 + {}", name, sets, scene.frames));
    }
  }
};

RecordingWriter::RecordingWriter(const std::filesystem::path& path, const SceneInfo& scene)
    : state_(std::make_unique<State>()) {
  const Header header = makeHeader(scene);
  state_->scene = scene;
  state_->name = path.string();
  state_->named = std::make_unique<AtomicFile>(path);
  state_->append(std::as_bytes(std::span(&header, 1)));
}

RecordingWriter::RecordingWriter(const SceneInfo& scene) : state_(std::make_unique<State>()) {
  const Header header = makeHeader(scene);
  state_->scene = scene;
  state_->name = recordingFileName(scene) + " (temporary)";
  state_->unnamed = unnamedFile(std::filesystem::temp_directory_path());
  state_->append(std::as_bytes(std::span(&header, 1)));
}

RecordingWriter::~RecordingWriter() = default;

void RecordingWriter::write(std::span<const Aabb> boxes) {
  if (boxes.size() != state_->scene.objects) {
    throw std::logic_error(fmt::format("{}: a set of {} boxes instead of {}", state_->name,
                                       boxes.size(), state_->scene.objects));
  }
  requireSound(boxes, state_->sets, state_->scene, state_->name);
  state_->append(std::as_bytes(boxes));
  ++state_->sets;
}

std::string RecordingWriter::finish() {
  state_->requireWhole();
  state_->named->commit();
  return state_->hasher.hex();
}

std::unique_ptr<RecordingReader> RecordingWriter::finishTemporary() {
  state_->requireWhole();
  return std::make_unique<RecordingReader>(std::move(state_->unnamed), state_->name);
}

bool recordAll(FrameSource& source, RecordingWriter& writer, const FrameProgress& progress) {
  std::optional<Frame> frame = source.rewind();
  for (; frame; frame = source.next()) {
    writer.write(frame->boxes);
    if (progress && !progress(frame->index)) return false;
  }
  return true;
}

}  // namespace broadmark
