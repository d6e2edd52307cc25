// Bullet 3's three broad phases on OpenCL: a uniform grid of 128³ wrapping cells (O(n) for bodies
// of similar size), a linear BVH (O(n log n + k)) and a sweep along one axis (about n^(5/3)). They
// are the paper's GPU families. Library: Debian's libBullet3OpenCL_clew.
//
// Each loses pairs by default; the workarounds here:
// - the grid's cells are as large as its largest small body, and hold any number of bodies; bodies
// far larger than most are passed as large ones, which the grid tests against all small ones;
// - no broad phase finds pairs of two large bodies: they are tested here, on the host;
// - the linear BVH's kernel reads past its end unless n = 1 (mod 64): padding with inverted boxes,
// which overlap nothing;
// - a full pair buffer truncates the answer silently: it is doubled and the search repeated;
// - the sweep's sort overflows from 2^19 bodies on: unsupported;
// - the radix sort assumes that groups of 64 run in lockstep, which GPUs do not guarantee: on any
// device except CPUs a known scene is checked first.
//
// The grid's kernels are global variables of the library. Each grid stores its own and installs
// them before every search and before its destruction (opencl/bullet_library.h); the host prevents
// concurrent calls (traits.exclusive). So any number of grids may coexist.
//
// Paper: Y. R. Serpa and M. A. F. Rodrigues, "Broadmark", Computer Graphics Forum, 2019; T. Karras,
// "Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees", HPG 2012 (the BVH);
// F. Liu, T. Harada, Y. Lee, Y. J. Kim, "Real-Time Collision Culling of a Million Bodies on
// Graphics Processing Units", SIGGRAPH Asia 2010 (the sweep).

#include <Bullet3OpenCL/BroadphaseCollision/b3GpuParallelLinearBvhBroadphase.h>
#include <Bullet3OpenCL/BroadphaseCollision/b3GpuSapBroadphase.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/reference_pairs.h"
#include "opencl/bullet_library.h"
#include "opencl/device_algorithm.h"
#include "opencl/device_context.h"

namespace broadmark::bullet_opencl {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();

b3SapAabb toBullet(const Aabb& box, int id) {
  b3SapAabb result;
  std::copy_n(box.min.begin(), 3, result.m_min);
  std::copy_n(box.max.begin(), 3, result.m_max);
  result.m_minIndices[3] = id;
  result.m_signedMaxIndices[3] = id;
  return result;
}

/// The division of bodies into small and large ones.
struct Sizes {
  b3AlignedObjectArray<int> small;
  b3AlignedObjectArray<int> large;
  float cell = 0;  ///< cell edge, above that of any small body
};

// The differences of the three: the library's class, its limits, and its input.

template <class Library>
struct UsualTraits {
  using BroadPhase = Library;
  static constexpr std::uint64_t kMaxObjects = 1 << 26;
  static constexpr std::string_view kExclusive = {};
  static constexpr bool kHasLarge = false;

  template <class... Options>
  static std::unique_ptr<Library> create(const opencl::DeviceContext& context, Options... options) {
    return std::make_unique<Library>(context.context()(), context.device()(), context.queue()(),
                                     options...);
  }
  static int padded(int count) { return count; }
  static void prepare(Library&, const Sizes&) {}
};

struct GridTraits : UsualTraits<opencl::BulletGrid> {
  /// The grid's kernels are global variables.
  static constexpr std::string_view kExclusive = "Bullet 3's OpenCL grid";
  static constexpr bool kHasLarge = true;

  static void prepare(BroadPhase& grid, const Sizes& sizes) { grid.setCellSize(sizes.cell); }
};

struct BvhTraits : UsualTraits<b3GpuParallelLinearBvhBroadphase> {
  static int padded(int count) { return (count + 62) / 64 * 64 + 1; }
};

struct SapTraits : UsualTraits<b3GpuSapBroadphase> {
  static constexpr std::uint64_t kMaxObjects = (1 << 19) - 1;

  static std::unique_ptr<BroadPhase> create(const opencl::DeviceContext& context) {
    return UsualTraits::create(context, BroadPhase::B3_GPU_SAP_KERNEL_ORIGINAL);
  }
  static void prepare(BroadPhase& sap, const Sizes& sizes) {
    sap.m_smallAabbsMappingCPU.resize(sizes.small.size());
  }
};

/// The library's object. It is made once per ExecutionContext: each leaks megabytes and takes a
/// fifth of a second for its kernels. It carries no state between answers.
template <class Traits>
class SharedLibrary final : public SharedResource {
 public:
  explicit SharedLibrary(ExecutionContext& execution) {
    const auto& context = execution.shared<opencl::DeviceContext>();
    opencl::loadBulletLibrary();
    const opencl::ScopedTimer timer(build_ns_);
    broad_phase_ = Traits::create(context);
    opencl::requireNoBulletError();
  }
  typename Traits::BroadPhase& broadPhase() { return *broad_phase_; }
  [[nodiscard]] std::int64_t buildNanoseconds() const { return build_ns_; }

 private:
  std::unique_ptr<typename Traits::BroadPhase> broad_phase_;
  std::int64_t build_ns_ = 0;
};

/// Directly on BroadPhase: the library returns all pairs at once.
template <class Traits>
class BulletOpenCl final : public BroadPhase {
 public:
  void initialize(const SceneInfo&, const Frame& first, ExecutionContext& execution) override {
    auto& library = execution.shared<SharedLibrary<Traits>>();
    broad_phase_ = &library.broadPhase();
    build_ns_ = library.buildNanoseconds();
    if (!execution.shared<opencl::DeviceContext>().onCpu()) requireSelfCheck();
    answer(first);
  }

  void updateObjects(const Frame& frame) override {
    const std::span<const Aabb> boxes = frame.boxes;
    transfers_ = {};
    count_ = static_cast<int>(boxes.size());
    host_boxes_.resize(Traits::padded(count_));
    for (int i = 0; i < count_; ++i) host_boxes_[i] = toBullet(boxes[i], i);
    const Aabb inverted = {{kLargest, kLargest, kLargest, 0}, {-kLargest, -kLargest, -kLargest, 0}};
    for (int i = count_; i < host_boxes_.size(); ++i) host_boxes_[i] = toBullet(inverted, i);
    divideBySize(boxes);

    const opencl::ScopedTimer timer(transfers_.upload_ns);
    broad_phase_->getAllAabbsGPU().copyFromHost(host_boxes_);
    broad_phase_->getSmallAabbIndicesGPU().copyFromHost(sizes_.small);
    broad_phase_->getLargeAabbIndicesGPU().copyFromHost(sizes_.large);
    Traits::prepare(*broad_phase_, sizes_);
    opencl::requireNoBulletError();
  }
  void cleanCache() override { pairs_.clear(); }
  void searchOverlaps() override {
    if (sizes_.small.size() > 0) {  // without bodies a grid's answer is undefined
      searchOnDevice();
      download();
    }
    addLargePairs();
    run_ = pairs_.run();
  }

  [[nodiscard]] PairRuns overlaps() const override { return {&run_, 1}; }
  [[nodiscard]] TransferTimes transfers() const override { return transfers_; }

  void visitCounters(const CounterVisitor& visit) const override {
    visit("large bodies", static_cast<std::uint64_t>(sizes_.large.size()));
  }
  void visitSetup(const CounterVisitor& visit) const override {
    visit("kernel_build_ns", static_cast<std::uint64_t>(build_ns_));
  }

 private:
  /// Farther from the origin the cell of a float is too inaccurate.
  static constexpr float kMaxCellsAway = 1 << 20;

  void answer(const Frame& frame) {
    updateObjects(frame);
    cleanCache();
    searchOverlaps();
  }

  static float longestEdge(const Aabb& box) {
    return static_cast<float>(broadmark::longestEdge(box));
  }

  static float distance(const Aabb& box) {
    float farthest = 0;
    for (int axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(box.min[axis]));
    return farthest;
  }

  /// Large bodies would make cells far too large for most bodies, or need too many cells.
  void divideBySize(std::span<const Aabb> boxes) {
    sizes_.small.resize(0);
    sizes_.large.resize(0);
    float edge = 0;
    float farthest = 0;
    const bool divides = Traits::kHasLarge && count_ > 0;
    const float reach = divides ? 2 * quantile(boxes, distance, 15) / kMaxCellsAway : 0;
    const float limit = divides ? std::max(reach, largestSmallEdge(boxes)) : kLargest;
    for (int i = 0; i < host_boxes_.size(); ++i) {
      const bool fits = !divides || (longestEdge(boxes[i]) <= limit &&
                                     distance(boxes[i]) / kMaxCellsAway < limit);
      (fits ? sizes_.small : sizes_.large).push_back(i);
      if (!fits || !divides) continue;
      edge = std::max({edge, reach, longestEdge(boxes[i])});
      farthest = std::max(farthest, distance(boxes[i]));
    }
    // A body's cell results from two roundings: a margin keeps neighbours in adjacent cells.
    constexpr float kRounding = 0x1p-21F;
    sizes_.cell = std::max(edge * 1.001F + farthest * kRounding, 1e-30F);
  }

  /// Four times the median, unless that makes more than one body in 16 large.
  float largestSmallEdge(std::span<const Aabb> boxes) {
    return std::max(4 * quantile(boxes, longestEdge, 8), quantile(boxes, longestEdge, 15));
  }

  template <class Measure>
  float quantile(std::span<const Aabb> boxes, Measure measure, std::size_t sixteenths) {
    ordered_.clear();
    std::ranges::transform(boxes, std::back_inserter(ordered_), measure);
    const auto at =
        ordered_.begin() + static_cast<std::ptrdiff_t>((ordered_.size() - 1) * sixteenths / 16);
    std::ranges::nth_element(ordered_, at);
    return *at;
  }

  void searchOnDevice() {
    max_pairs_ = std::max(max_pairs_, 4 * count_ + 1024);
    for (;;) {
      broad_phase_->calculateOverlappingPairs(max_pairs_);
      if (broad_phase_->getNumOverlap() < max_pairs_) break;
      opencl::dropBulletError();  // possibly an error about the full buffer
      if (max_pairs_ > std::numeric_limits<int>::max() / 2) {
        throw UnsupportedError("more pairs than the library can count");
      }
      max_pairs_ *= 2;
    }
    opencl::requireNoBulletError();
  }

  void download() {
    {
      const opencl::ScopedTimer timer(transfers_.download_ns);
      host_pairs_.resize(broad_phase_->getNumOverlap());
      if (host_pairs_.size() > 0) broad_phase_->getOverlappingPairsGPU().copyToHost(host_pairs_);
    }
    for (int i = 0; i < host_pairs_.size(); ++i) {
      pairs_.add(static_cast<std::uint32_t>(host_pairs_[i].x),
                 static_cast<std::uint32_t>(host_pairs_[i].y));
    }
  }

  void addLargePairs() {
    const auto overlap = [](const b3SapAabb& a, const b3SapAabb& b) {
      for (int axis = 0; axis < 3; ++axis) {
        if (a.m_min[axis] > b.m_max[axis] || b.m_min[axis] > a.m_max[axis]) return false;
      }
      return true;
    };
    const auto& large = sizes_.large;
    for (int i = 0; i < large.size(); ++i) {
      for (int j = i + 1; j < large.size(); ++j) {
        if (overlap(host_boxes_[large[i]], host_boxes_[large[j]])) {
          pairs_.add(static_cast<std::uint32_t>(large[i]), static_cast<std::uint32_t>(large[j]));
        }
      }
    }
  }

  /// On unit cubes 0.9 apart, each of which overlaps its neighbours.
  void requireSelfCheck() {
    std::vector<Aabb> boxes;
    constexpr int kSide = 12;
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
      Aabb& box = boxes.emplace_back();
      const int cell[] = {i % kSide, i / kSide % kSide, i / (kSide * kSide)};
      for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = 0.9F * static_cast<float>(cell[axis]);
        box.max[axis] = box.min[axis] + 1;
      }
    }
    answer({.boxes = boxes});
    const std::vector<Pair> right = bruteForcePairs(boxes);
    const PairRun right_run = right;
    if (digest({&run_, 1}) != digest({&right_run, 1})) {
      throw UnsupportedError(
          fmt::format("wrong pairs on this device in a start-up check ({} instead of {})",
                      pairs_.size(), right.size()));
    }
  }

  typename Traits::BroadPhase* broad_phase_ = nullptr;  ///< owned by the execution context
  std::int64_t build_ns_ = 0;
  TransferTimes transfers_;
  int count_ = 0;      ///< bodies without the padding
  int max_pairs_ = 0;  ///< capacity of the pair buffer
  Sizes sizes_;
  std::vector<float> ordered_;  ///< scratch memory for quantiles
  b3AlignedObjectArray<b3SapAabb> host_boxes_;
  b3AlignedObjectArray<b3Int4> host_pairs_;
  PairBuffer pairs_;
  PairRun run_;
};

template <class Traits>
Algorithm variant(std::string id, std::string summary, AlgorithmDescription description) {
  return opencl::deviceAlgorithm<BulletOpenCl<Traits>>(std::move(id), std::move(summary),
                                                       std::move(description), Traits::kMaxObjects,
                                                       std::string(Traits::kExclusive));
}

}  // namespace

std::vector<Algorithm> variants() {
  return {
      variant<GridTraits>("b3-grid", "Bullet 3's uniform grid on an OpenCL device",
                          {.principle = "grid",
                           .time = "O(n) for bodies of about one size",
                           .source = "Bullet 3.24; Serpa and Rodrigues 2019"}),
      variant<BvhTraits>(
          "b3-lbvh", "Bullet 3's linear BVH on an OpenCL device",
          {.principle = "tree", .time = "O(n log n + k)", .source = "Bullet 3.24; Karras 2012"}),
      variant<SapTraits>("b3-sap", "Bullet 3's sweep on an OpenCL device",
                         {.principle = "sorting",
                          .time = "O(n + w), w pairs that overlap on the sort axis",
                          .source = "Bullet 3.24; Liu et al. 2010"})};
}

}  // namespace broadmark::bullet_opencl
