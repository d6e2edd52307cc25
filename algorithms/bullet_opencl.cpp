// Bullet 3's three broad phases on OpenCL: a uniform grid of 128³ wrapping cells (O(n) for bodies
// of about one size), a linear BVH (O(n log n + k)) and a sweep along one axis (about n^(5/3)).
// They are the paper's GPU families. Library: Debian's libBullet3OpenCL_clew.
//
// Each loses pairs when it is used as it comes; what is done about it here:
// - the grid's cells are as large as its largest small body, and hold any number of bodies; bodies
//   far larger than most are handed over as large ones, which it tests against all small ones;
// - pairs of two large bodies are found by none of them: they are tested here, on the host;
// - the linear BVH's kernel reads past its end unless n = 1 (mod 64): inverted boxes, which meet
//   nothing, fill up;
// - a full pair buffer cuts the answer silently: it is doubled and the search done again;
// - the sweep's sort overflows from 2^19 bodies on: refused;
// - the radix sort counts on groups of 64 running in lockstep, which a GPU need not do: on anything
//   but a CPU the right answer on a known scene is asked for first.
//
// Paper: Y. R. Serpa and M. A. F. Rodrigues, "Broadmark", Computer Graphics Forum, 2019; T. Karras,
// "Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees", HPG 2012 (the BVH);
// F. Liu, T. Harada, Y. Lee, Y. J. Kim, "Real-Time Collision Culling of a Million Bodies on
// Graphics Processing Units", SIGGRAPH Asia 2010 (the sweep).

#include <Bullet3Common/b3Logging.h>
#include <Bullet3OpenCL/BroadphaseCollision/b3GpuGridBroadphase.h>
#include <Bullet3OpenCL/BroadphaseCollision/b3GpuParallelLinearBvhBroadphase.h>
#include <Bullet3OpenCL/BroadphaseCollision/b3GpuSapBroadphase.h>
#include <Bullet3OpenCL/Initialize/b3OpenCLUtils.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include "opencl/device_context.h"
#include "opencl/timer.h"
#include "broadmark/algorithm.h"
#include "broadmark/error.h"
#include "broadmark/oracle.h"

// Exported by the library, declared in none of its headers.
int b3OpenCLUtils_clewInit();
extern bool gDebugSkipLoadingBinary;

namespace broadmark::bullet_opencl {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();

/// Bullet tells of errors by this callback only.
thread_local std::string library_error;

/// Loads the library's OpenCL and keeps it quiet, once for the process. Throws UnsupportedError.
void initializeLibrary() {
  static const int status = [] {
    gDebugSkipLoadingBinary = true;  // or it writes a cache of its own beside the program
    b3OpenCLUtils_setCachePath("/dev/null");
    const auto ignore = [](const char*) {};
    b3SetCustomPrintfFunc(ignore);
    b3SetCustomWarningMessageFunc(ignore);
    b3SetCustomErrorMessageFunc([](const char* message) { library_error = message; });
    return b3OpenCLUtils_clewInit();
  }();
  if (status != 0) throw UnsupportedError("libOpenCL cannot be loaded");
}

/// Turns what the callback has heard into an exception.
void requireNoError() {
  if (library_error.empty()) return;
  std::string message = std::exchange(library_error, {});
  std::ranges::replace(message, '\n', ' ');
  throw std::runtime_error("Bullet: " + message);
}

b3SapAabb toBullet(const Aabb& box, int id) {
  b3SapAabb result;
  std::copy_n(box.min.begin(), 3, result.m_min);
  std::copy_n(box.max.begin(), 3, result.m_max);
  result.m_minIndices[3] = id;
  result.m_signedMaxIndices[3] = id;
  return result;
}

/// Which bodies a broad phase gets as small and as large ones.
struct Sizes {
  b3AlignedObjectArray<int> small;
  b3AlignedObjectArray<int> large;
  float cell = 0;  ///< edge of a cell that is larger than any small body
};

/// The library's grid with the two settings that it keeps to itself.
class Grid final : public b3GpuGridBroadphase {
 public:
  using b3GpuGridBroadphase::b3GpuGridBroadphase;

  void setCellSize(float size) {
    constexpr int kUnlimited = 1 << 20;
    for (int axis = 0; axis < 3; ++axis) m_paramsCPU.m_invCellSize[axis] = 1 / size;
    m_paramsCPU.setMaxBodiesPerCell(kUnlimited);
    m_paramsGPU.resize(1);
    m_paramsGPU.copyFromHostPointer(&m_paramsCPU, 1);
  }
};

// What differs between the three. Each: the library's class, its limits, and how it wants bodies.

struct GridTraits {
  using BroadPhase = Grid;
  static constexpr std::uint64_t kMaxObjects = 1 << 26;
  /// The grid's kernels are global variables of the library.
  static constexpr std::string_view kExclusive = "Bullet 3's OpenCL grid";
  static constexpr bool kHasLarge = true;

  static std::unique_ptr<Grid> create(const opencl::DeviceContext& context) {
    return std::make_unique<Grid>(context.context()(), context.device()(), context.queue()());
  }
  static int padded(int count) { return count; }
  static void prepare(Grid& grid, const Sizes& sizes) { grid.setCellSize(sizes.cell); }
};

struct BvhTraits {
  using BroadPhase = b3GpuParallelLinearBvhBroadphase;
  static constexpr std::uint64_t kMaxObjects = 1 << 26;
  static constexpr std::string_view kExclusive = {};
  static constexpr bool kHasLarge = false;

  static std::unique_ptr<BroadPhase> create(const opencl::DeviceContext& context) {
    return std::make_unique<BroadPhase>(context.context()(), context.device()(), context.queue()());
  }
  static int padded(int count) { return (count + 62) / 64 * 64 + 1; }
  static void prepare(BroadPhase&, const Sizes&) {}
};

struct SapTraits {
  using BroadPhase = b3GpuSapBroadphase;
  static constexpr std::uint64_t kMaxObjects = (1 << 19) - 1;
  static constexpr std::string_view kExclusive = {};
  static constexpr bool kHasLarge = false;

  static std::unique_ptr<BroadPhase> create(const opencl::DeviceContext& context) {
    return std::make_unique<BroadPhase>(context.context()(), context.device()(), context.queue()(),
                                        BroadPhase::B3_GPU_SAP_KERNEL_ORIGINAL);
  }
  static int padded(int count) { return count; }
  static void prepare(BroadPhase& sap, const Sizes& sizes) {
    sap.m_smallAabbsMappingCPU.resize(sizes.small.size());
  }
};

/// The library's object. It is made once for an Execution, as it leaks megabytes and takes a fifth
/// of a second for its kernels each time. Nothing in it lasts from one answer to the next.
template <class Traits>
class SharedLibrary final : public SharedResource {
 public:
  explicit SharedLibrary(Execution& execution) {
    const auto& context = execution.shared<opencl::DeviceContext>();
    initializeLibrary();
    const opencl::ScopedTimer timer(build_ns_);
    broad_phase_ = Traits::create(context);
    requireNoError();
  }
  typename Traits::BroadPhase& broadPhase() { return *broad_phase_; }
  [[nodiscard]] std::int64_t buildNanoseconds() const { return build_ns_; }

 private:
  std::unique_ptr<typename Traits::BroadPhase> broad_phase_;
  std::int64_t build_ns_ = 0;
};

template <class Traits>
class BulletOpenCl final : public BroadPhase {
 public:
  [[nodiscard]] Capabilities capabilities() const override {
    return {.max_objects = Traits::kMaxObjects, .exclusive = Traits::kExclusive};
  }

  void initialize(const SceneInfo&, const Frame& first, Execution& execution) override {
    auto& library = execution.shared<SharedLibrary<Traits>>();
    broad_phase_ = &library.broadPhase();
    build_ns_ = library.buildNanoseconds();
    if (!execution.shared<opencl::DeviceContext>().onCpu()) requireSelfCheck();
    run(first);
  }

  void updateObjects(const Frame& frame) override {
    transfers_ = {};
    count_ = static_cast<int>(frame.boxes.size());
    host_boxes_.resize(Traits::padded(count_));
    for (int i = 0; i < count_; ++i) host_boxes_[i] = toBullet(frame.boxes[i], i);
    const Aabb inverted = {{kLargest, kLargest, kLargest, 0}, {-kLargest, -kLargest, -kLargest, 0}};
    for (int i = count_; i < host_boxes_.size(); ++i) host_boxes_[i] = toBullet(inverted, i);
    divideBySize(frame.boxes);

    const opencl::ScopedTimer timer(transfers_.upload_ns);
    broad_phase_->getAllAabbsGPU().copyFromHost(host_boxes_);
    broad_phase_->getSmallAabbIndicesGPU().copyFromHost(sizes_.small);
    broad_phase_->getLargeAabbIndicesGPU().copyFromHost(sizes_.large);
    Traits::prepare(*broad_phase_, sizes_);
    requireNoError();
  }

  void cleanCache() override { pairs_.clear(); }

  void searchOverlaps() override {
    if (sizes_.small.size() > 0) {  // a grid without bodies answers with anything
      searchOnDevice();
      download();
    }
    addLargePairs();
    run_ = pairs_.run();
  }

  [[nodiscard]] PairRuns overlaps() const override { return {&run_, 1}; }
  [[nodiscard]] TransferTimes transfers() const override { return transfers_; }

  void visitCounters(const CounterVisitor& visit) const override {
    visit("kernel_build_ns", static_cast<std::uint64_t>(build_ns_));
    visit("large_bodies", static_cast<std::uint64_t>(sizes_.large.size()));
  }

 private:
  /// Beyond, a float hardly tells in which cell it lies.
  static constexpr float kMostCellsAway = 1 << 20;

  static float longestEdge(const Aabb& box) {
    float edge = 0;
    for (int axis = 0; axis < 3; ++axis) edge = std::max(edge, box.max[axis] - box.min[axis]);
    return edge;
  }

  static float distance(const Aabb& box) {
    float farthest = 0;
    for (int axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(box.min[axis]));
    return farthest;
  }

  /// Large are the bodies that would make cells far too large for most, or need too many of them.
  void divideBySize(std::span<const Aabb> boxes) {
    sizes_.small.resize(0);
    sizes_.large.resize(0);
    float edge = 0;
    float farthest = 0;
    const bool divides = Traits::kHasLarge && count_ > 0;
    const float reach = divides ? 2 * quantile(boxes, distance, 15) / kMostCellsAway : 0;
    const float limit = divides ? std::max(reach, largestSmallEdge(boxes)) : kLargest;
    for (int i = 0; i < host_boxes_.size(); ++i) {
      const bool fits = !divides || (longestEdge(boxes[i]) <= limit &&
                                     distance(boxes[i]) / kMostCellsAway < limit);
      (fits ? sizes_.small : sizes_.large).push_back(i);
      if (!fits || !divides) continue;
      edge = std::max({edge, reach, longestEdge(boxes[i])});
      farthest = std::max(farthest, distance(boxes[i]));
    }
    // A body's cell is found by two roundings: a little room keeps neighbours neighbours.
    constexpr float kRounding = 0x1p-21F;
    sizes_.cell = std::max(edge * 1.001F + farthest * kRounding, 1e-30F);
  }

  /// Four times the median, unless that leaves more than one body in 16 out.
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
      library_error.clear();  // it may have complained of the full buffer
      if (max_pairs_ > std::numeric_limits<int>::max() / 2) {
        throw UnsupportedError("more pairs than the library can count");
      }
      max_pairs_ *= 2;
    }
    requireNoError();
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

  void run(const Frame& frame) {
    updateObjects(frame);
    cleanCache();
    searchOverlaps();
  }

  /// Unit cubes on a lattice that is a little too narrow for them: each meets its neighbours.
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
    run({0, boxes});
    const std::vector<Pair> right = bruteForcePairs(boxes);
    const PairRun right_run = right;
    if (digest(overlaps()) != digest({&right_run, 1})) {
      throw UnsupportedError(
          fmt::format("wrong pairs on this device in a start-up check ({} instead of {})",
                      pairs_.size(), right.size()));
    }
  }

  typename Traits::BroadPhase* broad_phase_ = nullptr;  ///< the execution's
  std::int64_t build_ns_ = 0;
  TransferTimes transfers_;
  int count_ = 0;      ///< bodies, those that fill up not counted
  int max_pairs_ = 0;  ///< what the pair buffer is made for
  Sizes sizes_;
  std::vector<float> ordered_;  ///< room for quantiles
  b3AlignedObjectArray<b3SapAabb> host_boxes_;
  b3AlignedObjectArray<b3Int4> host_pairs_;
  PairBuffer pairs_;
  PairRun run_;
};

template <class Traits>
Algorithm variant(std::string id, std::string original_id, std::string summary,
                  std::string principle, std::string time) {
  return {.id = std::move(id),
          .family = "GPU",
          .summary = std::move(summary),
          .parallel = true,
          .on_device = true,
          .original_ids = {{std::move(original_id), {}}},
          .create = [] { return std::make_unique<BulletOpenCl<Traits>>(); },
          .library_allocates = true,
          .principle = std::move(principle),
          .optimisations = "OpenCL (Bullet 3)",
          .time = std::move(time),
          .space = "O(n + k)",
          .source = "Bullet 3.24; Serpa and Rodrigues 2019; Karras 2012; Liu et al. 2010"};
}

}  // namespace

std::vector<Algorithm> variants() {
  return {variant<GridTraits>("b3-grid", "GPU_Grid", "Bullet 3's uniform grid on an OpenCL device",
                              "grid", "O(n) for bodies of about one size"),
          variant<BvhTraits>("b3-lbvh", "GPU_LBVH", "Bullet 3's linear BVH on an OpenCL device",
                             "tree", "O(n log n + k)"),
          variant<SapTraits>("b3-sap", "GPU_SAP", "Bullet 3's sweep on an OpenCL device", "sorting",
                             "O(n + w), w pairs that overlap on the sort axis")};
}

}  // namespace broadmark::bullet_opencl
