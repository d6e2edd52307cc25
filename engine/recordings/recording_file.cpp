#include "recording_file.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

#include "broadmark/recordings/recording.h"

namespace broadmark {
namespace {

static_assert(std::endian::native == std::endian::little, "recordings are read and written as is");
static_assert(sizeof(RecordingHeader) == kRecordingHeaderBytes);
static_assert(sizeof(Aabb) == kRecordBytes);

constexpr std::size_t kTextBytes = 128;

/// Frames without objects take no bytes, so the file's length does not bound their number.
constexpr std::uint32_t kMaxEmptyFrames = 1'000'000;

/// Reads a NUL-padded text of the header.
std::string headerText(const char (&field)[kTextBytes], std::string_view what, std::size_t offset,
                       const std::string& name) {
  const auto* end = std::find(std::begin(field), std::end(field), '\0');
  std::string text(std::begin(field), end);
  if (!isName(text)) {
    throw InputError(
        fmt::format("{}: byte {}: the {} is not printable ASCII ended by a NUL: not a "
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

std::vector<std::byte> makeHeader(const SceneInfo& scene) {
  constexpr auto kMax = static_cast<std::uint32_t>(std::numeric_limits<std::int32_t>::max());
  requireNames(scene);
  if (scene.objects > kMax || scene.frames > kMax) {
    throw InputError(fmt::format("cannot record {} bodies and {} frames: at most {} each",
                                 scene.objects, scene.frames, kMax));
  }
  if (scene.objects == 0 && scene.frames > kMaxEmptyFrames) {
    throw InputError(fmt::format("cannot record {} frames without bodies: at most {} are allowed",
                                 scene.frames, kMaxEmptyFrames));
  }
  RecordingHeader header{};
  std::ranges::copy(scene.name, header.name);
  std::ranges::copy(scene.object_type, header.object_type);
  header.objects = static_cast<std::int32_t>(scene.objects);
  header.frames = static_cast<std::int32_t>(scene.frames);
  header.world = scene.world;
  const auto bytes = std::as_bytes(std::span(&header, 1));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

bool isName(std::string_view text) {
  return text.size() <= kMaxNameLength &&
         std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

void requireNames(const SceneInfo& scene) {
  const auto require = [](const std::string& text, std::string_view what) {
    if (isName(text)) return;
    throw InputError(
        fmt::format("cannot record the {} '{}': at most {} printable ASCII characters are allowed",
                    what, text, kMaxNameLength));
  };
  require(scene.name, "scene name");
  require(scene.object_type, "object type");
}

SceneInfo parseHeader(const RecordingHeader& header, const std::string& name) {
  SceneInfo scene;
  scene.name = headerText(header.name, "scene name", offsetof(RecordingHeader, name), name);
  scene.object_type =
      headerText(header.object_type, "object type", offsetof(RecordingHeader, object_type), name);
  scene.objects = headerCount(header.objects, "bodies", offsetof(RecordingHeader, objects), name);
  scene.frames = headerCount(header.frames, "frames", offsetof(RecordingHeader, frames), name);
  if (scene.objects == 0 && scene.frames > kMaxEmptyFrames) {
    throw InputError(fmt::format("{}: byte {}: {} frames without bodies: at most {} are allowed",
                                 name, offsetof(RecordingHeader, frames), scene.frames,
                                 kMaxEmptyFrames));
  }
  scene.world = header.world;
  if (const std::string wrong = fault(scene.world); !wrong.empty()) {
    throw InputError(fmt::format("{}: byte {}: the world box {}", name,
                                 offsetof(RecordingHeader, world), wrong));
  }
  return scene;
}

std::uint64_t setOffset(const SceneInfo& scene, std::uint64_t set) {
  return kRecordingHeaderBytes + sizeof(Aabb) * std::uint64_t{scene.objects} * set;
}

std::string fault(const Aabb& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const float low = box.min[axis];
    const float high = box.max[axis];
    if (std::isnan(low) || std::isnan(high)) return "is not a number (NaN)";
    if (std::isinf(low) || std::isinf(high)) return "is infinite";
    if (low > high) return "is inverted (min > max)";
  }
  return {};
}

std::string fault(const Pose& pose) {
  const auto any = [&](auto&& is) {
    return std::ranges::any_of(pose.position, is) || std::ranges::any_of(pose.rotation, is);
  };
  if (any([](float value) { return std::isnan(value); })) return "is not a number (NaN)";
  if (any([](float value) { return std::isinf(value); })) return "is infinite";
  const float squared = squaredLength(pose.rotation);
  if (std::abs(squared - 1) <= kRotationTolerance) return {};
  return fmt::format("has a quaternion of length {:.6g} (expected: 1)", std::sqrt(squared));
}

RecordingFile::RecordingFile(const std::filesystem::path& path, const SceneInfo& scene,
                             std::vector<std::byte> header)
    : scene_(scene) {
  if (path.empty()) {
    name_ = recordingFileName(scene) + " (temporary)";
    unnamed_ = unnamedFile();
  } else {
    name_ = path.string();
    named_ = std::make_unique<AtomicFile>(path);
  }
  append(header);
}

void RecordingFile::append(std::vector<std::byte>& block) {
  waitForWrite();
  size_ += block.size();
  std::swap(block, writing_block_);
  constexpr std::size_t kLarge = 1 << 20;  // takes longer than starting a thread
  if (writing_block_.size() < kLarge) return store(writing_block_);
  // Deferred, to waitForWrite(), if the system grants no more threads.
  writing_ =
      std::async(std::launch::async | std::launch::deferred, [this] { store(writing_block_); });
}

std::string RecordingFile::finish() {
  complete();
  waitForWrite();
  named_->commit();
  return hasher_.hex();
}

FileDescriptor RecordingFile::finishTemporary() {
  complete();
  waitForWrite();
  return std::move(unnamed_);
}

void RecordingFile::waitForWrite() {
  if (writing_.valid()) writing_.get();
}

void RecordingFile::store(std::span<const std::byte> bytes) {
  // In blocks, so that hashed data are still in the cache when written.
  constexpr std::size_t kBlock = 1 << 18;
  for (std::size_t start = 0; start < bytes.size(); start += kBlock) {
    const auto block = bytes.subspan(start, std::min(kBlock, bytes.size() - start));
    hasher_.add(block);
    if (named_) {
      named_->write(block);
    } else {
      writeAll(unnamed_.get(), block, name_);
    }
  }
}

void RecordingFile::requireBodies(std::size_t bodies) const {
  if (bodies == scene_.objects) return;
  throw std::logic_error(
      fmt::format("{}: a set of {} bodies instead of {}", name_, bodies, scene_.objects));
}

void RecordingFile::requireComplete(std::uint64_t sets) const {
  if (sets == std::uint64_t{1} + scene_.frames) return;
  throw std::logic_error(
      fmt::format("{}: {} sets written instead of 1 + {}", name_, sets, scene_.frames));
}

OriginalRecordingFile::OriginalRecordingFile(const std::filesystem::path& path,
                                             const SceneInfo& scene)
    : RecordingFile(path, scene, makeHeader(scene)) {}

}  // namespace broadmark
