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
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/c_deleter.h"
#include "broadmark/error.h"
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

  void answerQueries(AnswerKind) override { answers_queries_ = true; }

  void updateStructures() override {
    if (boxes().size() <= kMaxBruteForce) return;
    if (answers_queries_) enlargeBounds();
    threads_->run([this] {
      rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned>(boxes().size()));
      rtcCommitGeometry(geometry_.get());
      rtcCommitScene(scene_.get());
    });
  }

 private:
  void makeScene(RTCDevice device) {
    scene_.reset(rtcNewScene(device));
    unsigned flags = quality_ == RTC_BUILD_QUALITY_LOW ? RTC_SCENE_FLAG_DYNAMIC : 0;
    if (answers_queries_) flags |= RTC_SCENE_FLAG_ROBUST;  // misses no box by rounding
    rtcSetSceneFlags(scene_.get(), static_cast<RTCSceneFlags>(flags));
    rtcSetSceneBuildQuality(scene_.get(), quality_);
    geometry_.reset(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryBuildQuality(geometry_.get(), quality_);
    rtcSetGeometryUserData(geometry_.get(), this);
    rtcSetGeometryBoundsFunction(geometry_.get(), giveBounds, nullptr);
    rtcSetGeometryOccludedFunction(geometry_.get(), reportCrossed);
    rtcAttachGeometry(scene_.get(), geometry_.get());
  }

  /// Rays and distances are rounded: the candidates are those of larger boxes.
  void enlargeBounds() {
    constexpr float kMargin = 16 * std::numeric_limits<float>::epsilon();
    const float largest = largestCoordinate(boxes());
    if (largest > kMaxBound) throw UnsupportedError("coordinates beyond the range of Embree");
    margin_ = kMargin * largest;
  }

  static void giveBounds(const RTCBoundsFunctionArguments* of) {
    const auto& embree = *static_cast<Embree*>(of->geometryUserPtr);
    const Aabb box = enlarged(embree.boxes()[of->primID], embree.margin_);
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

  void findHits(const QueryBatch& batch) override {
    batch_ = &batch;
    const bool brute_force = boxes().size() <= kMaxBruteForce;
    threads_->run([&] {
      tbb::parallel_for(std::size_t{0}, batch.queries.size(), [&](std::size_t i) {
        const auto index = static_cast<std::uint32_t>(i);
        if (batch.kind == AnswerKind::nearest) {
          brute_force ? addAll(index) : findNearest(index);
        } else if (brute_force) {
          for (std::uint32_t body = 0; body < boxes().size(); ++body) addIfHit(index, body);
        } else {
          castRay(index);
        }
      });
    });
  }

  PairBuffer& ownPairs() { return pairs(tbb::this_task_arena::current_thread_index()); }

  void addIfHit(std::uint32_t query, std::uint32_t body) {
    if (hits(batch_->kind, batch_->queries[query], boxes()[body])) ownPairs().addHit(query, body);
  }

  /// Fewer bodies than a query for the nearest ones has.
  void addAll(std::uint32_t query) {
    static_assert(kMaxBruteForce <= kNearestBodies);
    for (std::uint32_t body = 0; body < boxes().size(); ++body) {
      if (!isEmpty(boxes()[body])) ownPairs().addHit(query, body);
    }
  }

  /// A ray that nothing occludes reports all bodies on its way.
  void castRay(std::uint32_t index) {
    const Query& query = batch_->queries[index];
    RTCRay ray{};
    ray.org_x = query.box.min[0];
    ray.org_y = query.box.min[1];
    ray.org_z = query.box.min[2];
    ray.dir_x = query.motion[0];
    ray.dir_y = query.motion[1];
    ray.dir_z = query.motion[2];
    ray.tfar = 1;
    ray.mask = ~0U;
    ray.id = index;
#if RTC_VERSION_MAJOR < 4
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_.get(), &context, &ray);
#else
    rtcOccluded1(scene_.get(), &ray, nullptr);
#endif
  }

  static void reportCrossed(const RTCOccludedFunctionNArguments* crossed) {
    if (crossed->valid[0] == 0) return;
    auto& embree = *static_cast<Embree*>(crossed->geometryUserPtr);
    embree.addIfHit(RTCRayN_id(crossed->ray, crossed->N, 0), crossed->primID);
  }

  /// The nearest bodies so far; the farthest is on top.
  struct Nearest {
    const Embree* embree;
    const Query* query;
    std::vector<std::pair<double, std::uint32_t>> heap;
  };

  void findNearest(std::uint32_t index) {
    const Query& query = batch_->queries[index];
    Nearest nearest{this, &query, {}};
    RTCPointQuery point{};
    point.x = query.box.min[0];
    point.y = query.box.min[1];
    point.z = query.box.min[2];
    point.radius = std::numeric_limits<float>::infinity();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_.get(), &point, &context, addNear, &nearest);
    for (const auto& [distance, body] : nearest.heap) ownPairs().addHit(index, body);
  }

  /// Returns whether the radius of the search has shrunk.
  static bool addNear(RTCPointQueryFunctionArguments* found) {
    auto& [embree, query, heap] = *static_cast<Nearest*>(found->userPtr);
    heap.emplace_back(distanceTo(*query, embree->boxes()[found->primID]), found->primID);
    std::ranges::push_heap(heap);
    if (heap.size() <= kNearestBodies) return false;
    std::ranges::pop_heap(heap);
    heap.pop_back();
    found->query->radius = std::nextafter(static_cast<float>(heap.front().first),
                                          std::numeric_limits<float>::infinity());
    return true;
  }

  RTCBuildQuality quality_;
  bool answers_queries_ = false;
  float margin_ = 0;
  const QueryBatch* batch_ = nullptr;  ///< of this frame
  Threads* threads_ = nullptr;
  Scene scene_;
  Geometry geometry_;
};

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {.family = "Embree",
                            .traits = {.queries = {AnswerKind::rays, AnswerKind::nearest},
                                       .library_allocates = true,
                                       .changing_worlds = ChangingWorlds::compacted},
                            .description = {.principle = "tree",
                                            .optimisations = "wide nodes, vector tests",
                                            .time = "O(n log n + k)",
                                            .space = "O(n + k)",
                                            .source = "Embree, rtcCollide; Wald et al. 2014"}};
  return {variantOf<Embree>(
              family, "embree-morton",
              "Embree's bounding volume hierarchy along a Morton curve, rebuilt every frame",
              {.parallel = true}, RTC_BUILD_QUALITY_LOW),
          variantOf<Embree>(
              family, "embree-sah",
              "Embree's bounding volume hierarchy by surface area heuristic, rebuilt every frame",
              {.parallel = true}, RTC_BUILD_QUALITY_MEDIUM)};
}

}  // namespace broadmark::embree
