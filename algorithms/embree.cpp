// Embree's collision of a bounding volume hierarchy with itself (rtcCollide): each frame a
// hierarchy of the boxes is built, as wide as the processor's vectors, and descended against
// itself. Two builds: along a Morton curve, quick to build, and by the surface area heuristic,
// quick to search. O(n log n + k) time, if the boxes are of one size, O(n) space.
//
// Each body is a primitive of one user geometry, as Embree's tutorial "collide" has it. For
// geometry that moves the manual ("Scene Object") advises a dynamic scene of low build quality:
// that is the Morton build, and its geometry must be of low quality, too. The other build is the
// default, medium. Both keep scene and geometry from frame to frame and commit them again.
//
// What is reported are pairs of primitives that may overlap, each pair twice: we keep one of them
// if the boxes overlap, so the answer is exact. Nothing is missed, as we hand over bounds which do
// not lose anything on the way (lowerBoundFor()): Embree drops boxes beyond 1.8e18, and while it
// builds denormal numbers count as 0. All of its other arithmetic on bounds are minima and maxima
// of floats.
//
// Its threads are those of TBB, in an arena of as many as we are given, or as there are cores.
//
// Nothing is drawn: the library does not show its hierarchy.
//
// Papers: I. Wald et al., "Embree: A Kernel Framework for Efficient CPU Ray Tracing", 2014;
// C. Lauterbach et al., "Fast BVH Construction on GPUs", 2009 (the Morton build). Library: Embree
// 3, manual, "rtcCollide".

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <stdexcept>

#include "broadmark/algorithm.h"
#include "broadmark/destroy.h"
#include "broadmark/reference_pairs.h"
#include "variants.h"

namespace broadmark::embree {
namespace {

using Device = std::unique_ptr<RTCDeviceTy, Destroy<rtcReleaseDevice>>;
using Scene = std::unique_ptr<RTCSceneTy, Destroy<rtcReleaseScene>>;
using Geometry = std::unique_ptr<RTCGeometryTy, Destroy<rtcReleaseGeometry>>;

/// Boxes are taken for no farther away than this: surfaces must not overflow, and Embree drops what
/// is beyond its FLT_LARGE, 1.844e18.
constexpr float kFarthest = 1e15F;
/// What becomes 0 where denormal numbers do is less than half of this.
constexpr float kRim = 2 * std::numeric_limits<float>::min();

/// A dynamic scene has another way for geometries of up to four primitives, which fails on boxes
/// without extent; and there is no hierarchy of less than two.
constexpr std::size_t kFew = 4;

/// Bounds for Embree that it keeps. They never swap places, so boxes that overlap still do; but
/// next to 0 and far away they are the very floats.
float lowerBoundFor(float bound) { return std::min(std::max(bound - kRim, -kFarthest), kFarthest); }
float upperBoundFor(float bound) { return std::min(std::max(bound + kRim, -kFarthest), kFarthest); }

/// Embree's device, which takes milliseconds to make, and the threads that work for it.
class Threads final : public SharedResource {
 public:
  explicit Threads(const ExecutionContext& execution)
      // TBB has no more threads than there are cores, and prints a warning when asked for them.
      : Threads(std::min(execution.threads(), tbb::info::default_concurrency())) {}

  [[nodiscard]] RTCDevice device() const { return device_.get(); }

  /// Has the library do work(), and throws what it reports as an error code.
  template <class Work>
  void run(Work work) {
    RTCError error = RTC_ERROR_NONE;
    arena_.execute([&] {
      work();
      error = rtcGetDeviceError(device());  // of this thread
    });
    if (error != RTC_ERROR_NONE) {
      throw std::runtime_error(fmt::format("Embree: error {}", static_cast<int>(error)));
    }
  }

 private:
  explicit Threads(int count)
      : arena_(count), device_(rtcNewDevice(fmt::format("threads={}", count).c_str())) {}

  tbb::task_arena arena_;
  Device device_;
};

class Embree final : public BoxBroadPhase {
 public:
  explicit Embree(RTCBuildQuality quality) : quality_(quality) {}

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    threads_ = &execution.shared<Threads>();
    threads_->run([this] { makeScene(threads_->device()); });
    updateStructures();
  }

  void updateStructures() override {
    if (boxes().size() <= kFew) return;
    threads_->run([this] {
      rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned>(boxes().size()));
      rtcCommitGeometry(geometry_.get());
      rtcCommitScene(scene_.get());
    });
  }

 private:
  void makeScene(RTCDevice device) {
    scene_.reset(rtcNewScene(device));
    if (quality_ == RTC_BUILD_QUALITY_LOW) rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene_.get(), quality_);
    geometry_.reset(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryBuildQuality(geometry_.get(), quality_);
    rtcSetGeometryUserData(geometry_.get(), this);
    rtcSetGeometryBoundsFunction(geometry_.get(), giveBounds, nullptr);
    rtcAttachGeometry(scene_.get(), geometry_.get());
  }

  static void giveBounds(const RTCBoundsFunctionArguments* of) {
    const Aabb& box = static_cast<Embree*>(of->geometryUserPtr)->boxes()[of->primID];
    RTCBounds& bounds = *of->bounds_o;
    bounds.lower_x = lowerBoundFor(box.min[0]);
    bounds.lower_y = lowerBoundFor(box.min[1]);
    bounds.lower_z = lowerBoundFor(box.min[2]);
    bounds.upper_x = upperBoundFor(box.max[0]);
    bounds.upper_y = upperBoundFor(box.max[1]);
    bounds.upper_z = upperBoundFor(box.max[2]);
  }

  void findPairs() override {
    if (boxes().size() <= kFew) {
      for (const Pair pair : bruteForcePairs(boxes())) pairs().add(pair.a, pair.b);
      return;
    }
    threads_->run([this] { rtcCollide(scene_.get(), scene_.get(), report, this); });
  }

  static void report(void* self, RTCCollision* found, unsigned count) {
    auto& embree = *static_cast<Embree*>(self);
    PairBuffer* own = nullptr;  // asked for where there is a pair: that takes time
    for (unsigned i = 0; i < count; ++i) {
      const std::uint32_t a = found[i].primID0;
      const std::uint32_t b = found[i].primID1;
      if (a >= b || !broadmark::overlaps(embree.boxes()[a], embree.boxes()[b])) continue;
      if (own == nullptr) own = &embree.pairs(tbb::this_task_arena::current_thread_index());
      own->add(a, b);
    }
  }

  RTCBuildQuality quality_;
  Threads* threads_ = nullptr;
  Scene scene_;
  Geometry geometry_;
};

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "Embree",
      .traits = {.library_allocates = true, .changing_worlds = ChangingWorlds::compacted},
      .description = {.principle = "tree",
                      .optimisations = "wide nodes, tested by vectors",
                      .time = "O(n log n + k)",
                      .space = "O(n + k)",
                      .source = "Embree, rtcCollide; Wald et al. 2014"}};
  return {variantOf<Embree>(
              family, "embree-morton",
              "Embree's bounding volume hierarchy along a Morton curve, from scratch every frame",
              {.parallel = true}, RTC_BUILD_QUALITY_LOW),
          variantOf<Embree>(
              family, "embree-sah",
              "Embree's bounding volume hierarchy by surface area, from scratch every frame",
              {.parallel = true}, RTC_BUILD_QUALITY_MEDIUM)};
}

}  // namespace broadmark::embree
