// Reading and writing .posrot recordings.

#include "broadmark/recordings/posrot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "recording_file.h"

namespace broadmark {
namespace {

static_assert(sizeof(Pose) == kRecordBytes && offsetof(Pose, rotation) == 16,
              "poses are read in file layout");

/// The distance from |x| to the next float.
float spacing(float x) {
  return std::nextafter(std::abs(x), std::numeric_limits<float>::infinity()) - std::abs(x);
}

/// Half an edge of a body with recorded bounds `low` and `high`. Both bounds are rounded, so
/// the same edge varies a little with the position; user-chosen sizes are usually whole
/// thousandths.
float halfEdge(float low, float high) {
  const double half = (double{high} - double{low}) / 2;
  const double rounded = std::round(half * 1000) / 1000;
  const double tolerance = 2 * double{spacing(std::max(std::abs(low), std::abs(high)))};
  return static_cast<float>(rounded > 0 && std::abs(rounded - half) <= tolerance ? rounded : half);
}

Vec3 halfExtentsOf(const Aabb& box) {
  return {halfEdge(box.min[0], box.max[0]), halfEdge(box.min[1], box.max[1]),
          halfEdge(box.min[2], box.max[2])};
}

}  // namespace

PosrotReader::PosrotReader(const std::filesystem::path& path)
    : PosrotReader(openForReading(path), path.string()) {}

PosrotReader::PosrotReader(FileDescriptor file, std::string name)
    : OriginalRecording(std::move(file), std::move(name)),
      are_spheres_(scene().object_type == "Spheres") {}

void PosrotReader::readSizes() {
  unrotated_.resize(scene().objects);
  readSet(0, std::as_writable_bytes(std::span(unrotated_)));
  requireValid<Aabb>(unrotated_, 0, scene(), name(), "box");
  half_extents_.resize(scene().objects);
  std::ranges::transform(unrotated_, half_extents_.begin(), halfExtentsOf);
}

std::span<const Aabb> PosrotReader::readBoxes(std::uint32_t index) {
  if (half_extents_.empty()) readSizes();
  if (index == 0) return unrotated_;
  poses_.resize(scene().objects);
  boxes_.resize(scene().objects);
  readSet(index, std::as_writable_bytes(std::span(poses_)));
  requireValid<Pose>(poses_, index, scene(), name(), "pose");
  for (std::size_t body = 0; body < poses_.size(); ++body) {
    const Pose& pose = poses_[body];
    boxes_[body] = boxAround(pose.position, extents(body, pose.rotation));
  }
  requireValid<Aabb>(boxes_, index, scene(), name(), "box");  // posed boxes may overflow
  return boxes_;
}

PosrotWriter::PosrotWriter(const std::filesystem::path& path, const SceneInfo& scene)
    : file_(std::make_unique<OriginalRecordingFile>(path, scene)) {}

PosrotWriter::~PosrotWriter() = default;

void PosrotWriter::writeBoxes(std::span<const Aabb> unrotated) { file_->append(unrotated, "box"); }

void PosrotWriter::write(std::span<const Pose> poses) {
  // Copied by component: in memory the fourth component of a position is undefined.
  records_.resize(poses.size());
  std::ranges::transform(poses, records_.begin(), [](const Pose& pose) {
    const auto& [x, y, z] = pose.position;
    const auto& q = pose.rotation;
    return std::array<float, 8>{x, y, z, 0, q[0], q[1], q[2], q[3]};
  });
  file_->append(poses, "pose", std::as_bytes(std::span(records_)));
}

std::string PosrotWriter::finish() { return file_->finish(); }

}  // namespace broadmark
