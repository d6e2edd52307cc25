// Linear bounding volume hierarchy on a compute device: bodies in Morton order, a binary radix tree
// over them built in one step, one traversal per body.
// O(n log n + k) for evenly spread boxes; sizes and distribution change the time only.
//
// Papers: C. Lauterbach, M. Garland, S. Sengupta, D. Luebke, D. Manocha, "Fast BVH Construction on
// GPUs", Eurographics 2009; T. Karras, "Maximizing Parallelism in the Construction of BVHs,
// Octrees, and k-d Trees", HPG 2012.

#include <bit>

#include "opencl/device_broad_phase.h"
#include "opencl_kernels.h"

namespace broadmark::gpu_lbvh {
namespace {

// As in lbvh.cl.
constexpr int kKeyBits = 30;
constexpr float kCellsPerAxis = 1024;
constexpr std::uint32_t kLeaf = 0x80000000;
struct Node {
  std::array<Aabb, 2> child;
};

/// Number of ranges on the level above `count` ranges.
constexpr std::size_t merged(std::size_t count) { return (count + 3) / 4; }

class GpuLbvh final : public opencl::DeviceBroadPhase {
 public:
  /// Reads the tree back and draws its inner nodes, to a visible depth.
  void drawStructure(DebugDraw& draw) const override {
    constexpr int kDeepest = 12;
    if (count() < 2) return;
    const auto nodes = read<Node>(nodes_, count() - 1);
    std::vector<std::pair<std::uint32_t, int>> stack = {{0, 0}};
    while (!stack.empty()) {
      const auto [number, depth] = stack.back();
      stack.pop_back();
      for (Aabb box : nodes[number].child) {
        const auto child = std::bit_cast<std::uint32_t>(box.min[3]);
        box.min[3] = box.max[3] = 0;
        draw.box(box, StructureRole::cell, depth);
        if ((child & kLeaf) == 0 && depth < kDeepest) stack.emplace_back(child, depth + 1);
      }
    }
  }

 protected:
  [[nodiscard]] std::string_view kernelSource() const override { return opencl_kernels::lbvh_cl(); }

  void makeKernels(const cl::Program& program) override {
    make_keys_ = cl::Kernel(program, "make_keys");
    gather_ = cl::Kernel(program, "gather");
    merge_ranges_ = cl::Kernel(program, "merge_ranges");
    build_ = cl::Kernel(program, "build");
    search_ = cl::Kernel(program, "search");
  }

  void reserve(std::size_t count) override {
    std::size_t ranges = count;
    for (std::size_t level = count; level > 1; ranges += level) level = merged(level);
    ranges_ = context().buffer(ranges * sizeof(Aabb));
    nodes_ = context().buffer(count * sizeof(Node));
  }

  void build() override {
    const opencl::FrameSummary summary = summarise();
    cl_float4 low{};
    cl_float4 scale{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low.s[axis] = summary.bounds.min[axis];
      // Half the extent twice: the whole may exceed the range of a float.
      const float half = summary.bounds.max[axis] / 2 - summary.bounds.min[axis] / 2;
      scale.s[axis] = half > 0 ? kCellsPerAxis / 2 / half : 0;
      if (!(scale.s[axis] < 1e30F)) scale.s[axis] = 0;
    }
    forBodies(make_keys_, count(), boxes(), n(), low, scale, sorter().keys(), sorter().values());
    sorter().sort(kKeyBits);
    forBodies(gather_, count(), boxes(), sorter().values(), n(), ranges_);
    cl_uint first = 0;
    for (std::size_t level = count(); level > 1; level = merged(level)) {
      forBodies(merge_ranges_, merged(level), ranges_, first, static_cast<cl_uint>(level),
                static_cast<cl_uint>(merged(level)));
      first += static_cast<cl_uint>(level);
    }
    if (count() > 1) forBodies(build_, count() - 1, sorter().keys(), ranges_, n(), nodes_);
  }

  void search(const opencl::PairSink& sink) override {
    forBodies(search_, count(), ranges_, nodes_, sorter().values(), n(), sink.pairs, sink.count,
              sink.capacity);
  }

 private:
  cl::Kernel make_keys_;
  cl::Kernel gather_;
  cl::Kernel merge_ranges_;
  cl::Kernel build_;
  cl::Kernel search_;
  cl::Buffer ranges_;  ///< leaves, then the levels of merged ranges
  cl::Buffer nodes_;
};

}  // namespace

std::vector<Algorithm> variants() {
  return {opencl::deviceAlgorithm<GpuLbvh>("gpu-lbvh",
                                           "linear bounding volume hierarchy on an OpenCL device",
                                           {.principle = "tree",
                                            .optimisations = "Morton order, radix sort",
                                            .time = "O(n log n + k)",
                                            .source = "Lauterbach et al. 2009; Karras 2012"})};
}

}  // namespace broadmark::gpu_lbvh
