// Sweep and prune on a compute device: bodies sorted by their lower bound on the axis of largest
// variance; each searches its own window, sixteen bodies at a time. O(n + w), w the pairs that
// overlap on the sort axis: about n^(5/3) for evenly spread boxes. Any number of bodies, of any
// sizes, up to the device's memory.
//
// Papers: F. Liu, T. Harada, Y. Lee, Y. J. Kim, "Real-Time Collision Culling of a Million Bodies on
// Graphics Processing Units", SIGGRAPH Asia 2010; D. G. Merrill and A. S. Grimshaw, "Revisiting
// Sorting for GPGPU Stream Architectures", PACT 2010 (the sort).

#include <algorithm>

#include "opencl/device_broad_phase.h"
#include "opencl_kernels.h"

namespace broadmark::gpu_sap {
namespace {

class GpuSap final : public opencl::DeviceBroadPhase {
 public:
  void drawStructure(DebugDraw& draw) const override {
    std::array<float, 3> from{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      from[axis] = bounds_.min[axis] / 2 + bounds_.max[axis] / 2;
    }
    std::array<float, 3> to = from;
    from[axis_] = bounds_.min[axis_];
    to[axis_] = bounds_.max[axis_];
    draw.line(from, to, StructureRole::split);
  }

 protected:
  [[nodiscard]] std::string_view kernelSource() const override { return opencl_kernels::sap_cl(); }

  void makeKernels(const cl::Program& program) override {
    make_keys_ = cl::Kernel(program, "make_keys");
    gather_ = cl::Kernel(program, "gather");
    search_ = cl::Kernel(program, "search");
  }

  void reserve(std::size_t count) override { sorted_ = sortedBoxes(count); }

  void build() override {
    const opencl::FrameSummary summary = summarise();
    bounds_ = summary.bounds;
    axis_ =
        static_cast<cl_uint>(std::ranges::max_element(summary.variance) - summary.variance.begin());
    forBodies(make_keys_, count(), boxes(), n(), axis_, sorter().keys(), sorter().values());
    sorter().sort(32);
    forBodies(gather_, count() + opencl::kPadding, boxes(), sorter().values(), n(), axis_, stride(),
              sorted_);
  }

  void search(const opencl::PairSink& sink) override {
    forBodies(search_, count(), sorted_, sorter().values(), n(), stride(), sink.pairs, sink.count,
              sink.capacity);
  }

 private:
  cl::Kernel make_keys_;
  cl::Kernel gather_;
  cl::Kernel search_;
  cl::Buffer sorted_;
  Aabb bounds_;
  cl_uint axis_ = 0;
};

}  // namespace

std::vector<Algorithm> variants() {
  return {
      opencl::deviceAlgorithm<GpuSap>("gpu-sap", "sweep and prune on an OpenCL device",
                                      {.principle = "sorting",
                                       .optimisations = "axis by variance, radix sort, vectors",
                                       .time = "O(n + w), w pairs that overlap on the sort axis",
                                       .source = "Liu et al. 2010; Merrill and Grimshaw 2010"})};
}

}  // namespace broadmark::gpu_sap
