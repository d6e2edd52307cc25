// Hierarchical grid on a compute device: each body is in one cell, of a level for its size; bodies
// are sorted by cell; each queries the cells around it on its own level and the coarser ones. O(n +
// k) for bodies of any sizes, as long as few share a cell; memory is O(n), regardless of distances.
//
// Papers: S. Le Grand, "Broad-Phase Collision Detection with CUDA", GPU Gems 3, 2007 (the sorted
// grid); M. Teschner, B. Heidelberger, M. Müller, D. Pomeranets, M. Gross, "Optimized Spatial
// Hashing for Collision Detection of Deformable Objects", VMV 2003; C. Ericson, "Real-Time
// Collision Detection", 2005, 7.2 (the hierarchy).

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "opencl/device_broad_phase.h"
#include "opencl_kernels.h"

namespace broadmark::gpu_grid {
namespace {

/// Per body: enough for a cell each where bodies take a tenth of the space.
constexpr std::size_t kMaxBuckets = 4;

// As in grid.cl.
constexpr int kLevels = 21;
struct Grid {
  cl_float4 scale;
  cl_float4 origin;
  cl_uint4 bits;
  cl_uint4 edge;
};

class GpuGrid final : public opencl::DeviceBroadPhase {
 public:
  /// Reads the boxes back and draws the cells that hold bodies.
  void drawStructure(DebugDraw& draw) const override {
    constexpr std::size_t kMaxCells = 20'000;
    if (count() < 2) return;
    std::map<Cell, std::uint32_t> populations;
    for (const Aabb& box : read<Aabb>(boxes(), count())) ++populations[cellOf(box)];
    std::size_t drawn = 0;
    for (const auto& [cell, population] : populations) {
      if (++drawn > kMaxCells) return;
      draw.cell(boxOf(cell), cell.level, population);
    }
  }

 protected:
  [[nodiscard]] std::string_view kernelSource() const override { return opencl_kernels::grid_cl(); }

  void makeKernels(const cl::Program& program) override {
    make_keys_ = cl::Kernel(program, "make_keys");
    gather_ = cl::Kernel(program, "gather");
    search_ = cl::Kernel(program, "search");
    used_levels_ = context().buffer(sizeof(cl_uint));
  }

  void reserve(std::size_t count) override {
    sorted_ = sortedBoxes(count);
    starts_ = context().buffer((std::bit_ceil(kMaxBuckets * count) + 1) * sizeof(cl_uint));
  }

  void build() override {
    chooseGrid(summarise());
    context().queue().enqueueFillBuffer(used_levels_, cl_uint{0}, 0, sizeof(cl_uint));
    forBodies(make_keys_, count(), boxes(), n(), grid_, sorter().keys(), sorter().values(),
              used_levels_);
    sorter().sort(tableBits());
    const auto buckets = cl_uint{1} << tableBits();
    forBodies(gather_, count() + opencl::kPadding, boxes(), sorter().keys(), sorter().values(), n(),
              buckets, stride(), sorted_, starts_);
  }

  void search(const opencl::PairSink& sink) override {
    forBodies(search_, count(), sorted_, stride(), sorter().values(), starts_, n(), grid_, wraps_,
              used_levels_, sink.pairs, sink.count, sink.capacity);
  }

 private:
  struct Cell {
    int level = 0;
    std::array<std::uint32_t, 3> at{};
    friend auto operator<=>(const Cell&, const Cell&) = default;
  };

  [[nodiscard]] int tableBits() const {
    return static_cast<int>(grid_.bits.s[0] + grid_.bits.s[1] + grid_.bits.s[2]);
  }

  /// Units about as large as a typical body; larger if coordinates would need too many of them.
  void chooseGrid(const opencl::FrameSummary& summary) {
    constexpr double kMaxUnits = 1 << (kLevels - 1);
    double unit = std::max(summary.mean_edge * 1.01, 1e-30);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double low = summary.bounds.min[axis];
      const double high = summary.bounds.max[axis];
      unit = std::max({unit, (high - low) / (kMaxUnits - 2),
                       std::max(std::abs(low), std::abs(high)) / (1 << 23)});
    }
    // Larger than bodies, so that queries visit few rows of cells; more so where sixteen bodies are
    // tested at once, but not along x, on which the next cell is contiguous in memory.
    const int across = likeGpu() ? 1 : 2;
    const std::array<int, 3> edge = {1, across, across};
    std::array<int, 3> bits{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      grid_.scale.s[axis] = static_cast<float>(1 / unit);
      grid_.origin.s[axis] = summary.bounds.min[axis] * grid_.scale.s[axis];
      grid_.edge.s[axis] = static_cast<cl_uint>(edge[axis]);
      // One more, as a device may round differently.
      const std::uint32_t units = unitOf(summary.bounds.max[axis], axis) + 1;
      bits[axis] = static_cast<int>(std::bit_width(units >> edge[axis]));
    }
    grid_.scale.s[3] = grid_.origin.s[3] = 0;
    const auto most = static_cast<int>(std::bit_width(kMaxBuckets * count() - 1));
    wraps_ = bits[0] + bits[1] + bits[2] > most ? 1 : 0;
    while (bits[0] + bits[1] + bits[2] > most) --*std::ranges::max_element(bits);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      grid_.bits.s[axis] = static_cast<cl_uint>(bits[axis]);
    }
  }

  [[nodiscard]] int edgeBits(std::size_t axis) const {
    return static_cast<int>(grid_.edge.s[axis]);
  }

  /// As unit_of in grid.cl.
  [[nodiscard]] std::uint32_t unitOf(float coordinate, std::size_t axis) const {
    constexpr float kLast = (1 << (kLevels - 1)) - 1;
    return static_cast<std::uint32_t>(
        std::clamp(coordinate * grid_.scale.s[axis] - grid_.origin.s[axis], 0.0F, kLast));
  }

  [[nodiscard]] Cell cellOf(const Aabb& box) const {
    Cell cell;
    const auto fits = [&](std::size_t axis) {
      return unitOf(box.max[axis], axis) - unitOf(box.min[axis], axis) <= 1U << cell.level;
    };
    while (!(fits(0) && fits(1) && fits(2))) ++cell.level;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cell.at[axis] = unitOf(box.min[axis], axis) >> (cell.level + edgeBits(axis));
    }
    return cell;
  }

  [[nodiscard]] Aabb boxOf(const Cell& cell) const {
    Aabb box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto edge = static_cast<float>(1U << (cell.level + edgeBits(axis)));
      const float low = static_cast<float>(cell.at[axis]) * edge + grid_.origin.s[axis];
      box.min[axis] = low / grid_.scale.s[axis];
      box.max[axis] = (low + edge) / grid_.scale.s[axis];
    }
    return box;
  }

  cl::Kernel make_keys_;
  cl::Kernel gather_;
  cl::Kernel search_;
  cl::Buffer used_levels_;
  cl::Buffer sorted_;
  cl::Buffer starts_;
  Grid grid_{};
  cl_uint wraps_ = 0;  ///< whether cells share buckets
};

}  // namespace

std::vector<Algorithm> variants() {
  return {opencl::deviceAlgorithm<GpuGrid>(
      "gpu-grid", "hierarchical grid on an OpenCL device",
      {.principle = "grid",
       .optimisations = "radix sort, levels by size",
       .time = "O(n + k) with few bodies per cell",
       .source = "Le Grand 2007; Teschner et al. 2003; Ericson 2005, 7.2"})};
}

}  // namespace broadmark::gpu_grid
