// Embree's collision of a bounding volume hierarchy with itself (rtcCollide): each frame a
// hierarchy of the boxes is built, as wide as the processor's vectors, and traversed against
// itself. Two builds: along a Morton curve, with a fast build, and by the surface area heuristic,
// with a fast search. O(n log n + k) time for boxes of similar size, O(n) space.
//
// Each body is a primitive of one user geometry, as in Embree's tutorial "collide". For moving
// geometry the manual ("Scene Object") recommends a dynamic scene of low build quality: that is the
// Morton build, and its geometry must be of low quality, too. The other build is the default,
// medium. Both retain scene and geometry between frames and commit them again.
//
// Embree reports pairs of primitives that may overlap, each pair twice: one of them is kept if the
// boxes overlap, so the answer is exact. No pair is missed, as the bounds passed to it are adjusted
// (lowerBoundFor()): Embree drops boxes beyond 1.8e18, and treats denormal numbers as 0 during the
// build. All of its other arithmetic on bounds is minima and maxima of floats.
//
// Its threads are those of TBB, in an arena limited to the given threads and the number of cores.
//
// No drawing: the library does not expose its hierarchy.
//
// Papers: I. Wald et al., "Embree: A Kernel Framework for Efficient CPU Ray Tracing", 2014;
// C. Lauterbach et al., "Fast BVH Construction on GPUs", 2009 (the Morton build). Library: Embree
// 3 or 4, manual, "rtcCollide".

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/format.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>

#include "broadmark/algorithm.h"
#include "broadmark/c_deleter.h"
#include "broadmark/reference_pairs.h"
#include "variants.h"

namespace broadmark::embree {
namespace {

using Device = std::unique_ptr<RTCDeviceTy, CDeleter<rtcReleaseDevice>>;
using Scene = std::unique_ptr<RTCSceneTy, CDeleter<rtcReleaseScene>>;
using Geometry = std::unique_ptr<RTCGeometryTy, CDeleter<rtcReleaseGeometry>>;

/// Boxes are clamped to this distance: surface areas must not overflow, and Embree drops boxes
/// beyond its FLT_LARGE, 1.844e18.
constexpr float kMaxBound = 1e15F;
/// More than twice any number that is flushed to 0.
constexpr float kBoundMargin = 2 * std::numeric_limits<float>::min();

/// Up to this many primitives, dynamic scenes use another code path, which fails on boxes without
/// extent; and a hierarchy needs two primitives.
constexpr std::size_t kMaxBruteForce = 4;

/// Adjusted bounds, which Embree preserves. They are monotonic, so boxes that overlap still do;
/// except near 0 and far away they are the original floats.
float lowerBoundFor(float bound) {
  return std::min(std::max(bound - kBoundMargin, -kMaxBound), kMaxBound);
}
float upperBoundFor(float bound) {
  return std::min(std::max(bound + kBoundMargin, -kMaxBound), kMaxBound);
}

/// Embree's device, which takes milliseconds to make, and its threads.
class Threads final : public SharedResource {
 public:
  explicit Threads(const ExecutionContext& execution)
      // TBB has no more threads than cores, and prints a warning on requests for more.
      : Threads(std::min(execution.threads(), tbb::info::default_concurrency())) {}

  [[nodiscard]] RTCDevice device() const { return device_.get(); }

  /// Runs work() in the library, and throws its error code as an exception.
  template <class Work>
  void run(Work work) {
    RTCError error = RTC_ERROR_NONE;
    arena_.execute([&] {
      work();
      error = rtcGetDeviceError(device());  // of this thread
    });
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
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
    if (boxes().size() <= kMaxBruteForce) return;
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
    if (boxes().size() <= kMaxBruteForce) {
      for (const Pair pair : bruteForcePairs(boxes())) pairs().add(pair.a, pair.b);
      return;
    }
    threads_->run([this] { rtcCollide(scene_.get(), scene_.get(), report, this); });
  }

  static void report(void* self, RTCCollision* found, unsigned count) {
    auto& embree = *static_cast<Embree*>(self);
    PairBuffer* own = nullptr;  // queried on the first pair only, as that takes time
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
