// Splitter: large scenes from small ones. World and bodies grow to twice their size, then each body
// is cut into eight of its former size: 8n bodies that move like n, at the same density, for a few
// additions each. Its recordings can be split again.

#include <Eigen/Geometry>
#include <array>

#include "broadmark/recordings/posrot.h"
#include "engines/replay.h"
#include "entries.h"

namespace broadmark::scenes::splitter {
namespace {

constexpr std::size_t kParts = 8;

/// The sign of part `part` along `axis`.
constexpr float side(std::size_t part, int axis) { return (part >> axis & 1) != 0 ? 1.0F : -1.0F; }

/// The centres of a body's parts: twice its position ± each of its rotated half edges.
std::array<Vec3, kParts> centresOf(const Vec3& half_extents, const Pose& pose) {
  const Eigen::Matrix3f edges = Eigen::Quaternionf(pose.rotation.data()).toRotationMatrix() *
                                Eigen::Vector3f(half_extents.data()).asDiagonal();
  std::array<Vec3, kParts> centres;
  for (std::size_t part = 0; part < kParts; ++part) {
    for (int i = 0; i < 3; ++i) {
      centres[part][i] = 2 * pose.position[i] + side(part, 0) * edges(i, 0) +
                         side(part, 1) * edges(i, 1) + side(part, 2) * edges(i, 2);
    }
  }
  return centres;
}

/// An eighth of a box that has grown to twice its size. The parts' faces coincide exactly.
Aabb partOf(const Aabb& box, std::size_t part) {
  Aabb eighth;
  for (int axis = 0; axis < 3; ++axis) {
    const float middle = box.min[axis] + box.max[axis];
    const bool upper = side(part, axis) > 0;
    eighth.min[axis] = upper ? middle : 2 * box.min[axis];
    eighth.max[axis] = upper ? 2 * box.max[axis] : middle;
  }
  return eighth;
}

SceneInfo grown(SceneInfo scene) {
  scene.objects *= kParts;
  for (int axis = 0; axis < 3; ++axis) {
    scene.world.min[axis] *= 2;
    scene.world.max[axis] *= 2;
  }
  return scene;
}

class Splitter final : public Replay {
 public:
  explicit Splitter(std::unique_ptr<Recording> recording)
      : Replay(std::move(recording)),
        whole_(dynamic_cast<PosrotReader&>(this->recording())),
        info_(grown(whole_.scene())) {}

  [[nodiscard]] const SceneInfo& scene() const override { return info_; }

  Frame rewind() override {
    const Frame whole = whole_.rewind();
    boxes_.resize(info_.objects);
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      boxes_[i] = partOf(whole.boxes[i / kParts], i % kParts);
    }
    return {whole.index, boxes_};
  }

  std::optional<Frame> next() override {
    const auto whole = whole_.next();
    if (!whole) return {};
    forEachBody([this](std::size_t body, const Pose& pose, const auto& centres) {
      // Each part has the size and rotation of the body.
      const Vec3 extents = whole_.extents(body, pose.rotation);
      for (std::size_t part = 0; part < kParts; ++part) {
        boxes_[kParts * body + part] = boxAround(centres[part], extents);
      }
    });
    return Frame{whole->index, boxes_};
  }

  /// Bodies are unrotated in the initial pose.
  std::span<const Aabb> unrotatedBoxes() override { return boxes_; }

  /// Computed only on demand.
  std::span<const Pose> poses() override {
    poses_.resize(info_.objects);
    forEachBody([this](std::size_t body, const Pose& pose, const auto& centres) {
      for (std::size_t part = 0; part < kParts; ++part) {
        poses_[kParts * body + part] = {centres[part], pose.rotation};
      }
    });
    return poses_;
  }

 private:
  template <class Visit>
  void forEachBody(Visit&& visit) {
    const std::span<const Pose> poses = whole_.poses();
    for (std::size_t body = 0; body < poses.size(); ++body) {
      visit(body, poses[body], centresOf(whole_.halfExtents()[body], poses[body]));
    }
  }

  PosrotReader& whole_;  ///< the recording
  SceneInfo info_;
  std::vector<Aabb> boxes_;
  std::vector<Pose> poses_;
};

}  // namespace

ReplayEntry entry() {
  return {.listing = {.id = "splitter",
                      .summary = "replays a .posrot recording with eight bodies for each one",
                      .dynamics = Dynamics::replayed},
          .bodies_per_recorded = kParts,
          .extensions = {kPosrotExtension},
          .create = makeEntry<Replay, Splitter>};
}

}  // namespace broadmark::scenes::splitter
