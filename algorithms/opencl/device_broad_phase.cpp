#include "opencl/device_broad_phase.h"

#include <fmt/format.h>

#include <algorithm>

#include "broadmark/error.h"
#include "opencl_kernels.h"

namespace broadmark::opencl {
namespace {

constexpr std::size_t kStrips = 256;  ///< parts for summarising the boxes
constexpr std::size_t kSumsPerStrip = 5;
/// As in common.cl: kernels stop counting about here.
constexpr cl_uint kMaxPairs = 0x80000000;

/// A corner or a sum, as written by kernels.
using Float4 = std::array<float, 4>;

}  // namespace

void DeviceBroadPhase::visitParameters(const ParameterVisitor& visit) {
  visit({"work_division", "how work is divided: for a CPU's few threads or a GPU's many",
         &work_division_});
}

bool DeviceBroadPhase::likeGpu() const {
  return work_division_.value == "auto" ? !context_->onCpu() : work_division_.value == "gpu";
}

void DeviceBroadPhase::initialize(const SceneInfo&, const Frame& first,
                                  ExecutionContext& execution) {
  context_ = &execution.shared<DeviceContext>();
  makeProgram();
  updateObjects(first);
  updateStructures();
  searchOverlaps();
}

void DeviceBroadPhase::makeProgram() {
  bodies_per_item_ = likeGpu() ? 1 : 256;
  group_ = likeGpu() ? 64 : 1;
  const std::string source = fmt::format("{}{}", opencl_kernels::common_cl(), kernelSource());
  const cl::Program program = context_->build(
      source, fmt::format("-DBODIES_PER_ITEM={} -DPAIRS_HELD={} -DLANES={}", bodies_per_item_,
                          likeGpu() ? 1 : 32, likeGpu() ? 1 : 16));
  summarise_ = cl::Kernel(program, "summarise");
  summaries_ = context_->buffer(kStrips * kSumsPerStrip * sizeof(Float4));
  sorter_.emplace(*context_, likeGpu());
  sink_.count = context_->buffer(sizeof(cl_uint));
  makeKernels(program);
}

void DeviceBroadPhase::updateObjects(const Frame& frame) {
  transfers_ = {};
  count_ = frame.boxes.size();
  if (count_ < 2) return;
  if (count_ > capacity_) {
    capacity_ = count_;
    boxes_ = context_->buffer(count_ * sizeof(Aabb));
    sorter_->resize(count_);
    reserve(count_);
  }
  sorter_->resize(count_);
  const ScopedTimer timer(transfers_.upload_ns);
  context_->queue().enqueueWriteBuffer(boxes_, CL_TRUE, 0, frame.boxes.size_bytes(),
                                       frame.boxes.data());
}

void DeviceBroadPhase::cleanCache() {
  pairs_.clear();
  run_ = {};
}

void DeviceBroadPhase::updateStructures() {
  if (count_ < 2) return;
  build();
  context_->queue().finish();
}

void DeviceBroadPhase::searchOverlaps() {
  cleanCache();
  if (count_ < 2) return;
  cl_uint found = searchOnce();
  while (found > sink_.capacity) {
    if (found >= kMaxPairs) throw UnsupportedError("more than 2^31 overlapping pairs");
    // With a margin, as otherwise every frame of a growing heap would need a second search.
    sink_.capacity = found + found / 4 + 1024;
    sink_.pairs = context_->buffer(std::size_t{sink_.capacity} * sizeof(Pair));
    found = searchOnce();
  }
  const ScopedTimer timer(transfers_.download_ns);
  if (found > 0) {
    context_->queue().enqueueReadBuffer(sink_.pairs, CL_TRUE, 0, found * sizeof(Pair),
                                        pairs_.room(found));
  }
  pairs_.advance(found);
  run_ = pairs_.run();
}

cl_uint DeviceBroadPhase::searchOnce() {
  if (sink_.capacity == 0) {
    sink_.capacity = static_cast<cl_uint>(std::min<std::size_t>(2 * count_ + 1024, kMaxPairs - 1));
    sink_.pairs = context_->buffer(std::size_t{sink_.capacity} * sizeof(Pair));
  }
  const cl::CommandQueue& queue = context_->queue();
  queue.enqueueFillBuffer(sink_.count, cl_uint{0}, 0, sizeof(cl_uint));
  search(sink_);
  cl_uint found = 0;
  queue.enqueueReadBuffer(sink_.count, CL_TRUE, 0, sizeof found, &found);
  return found;
}

FrameSummary DeviceBroadPhase::summarise() {
  const auto strip = static_cast<cl_uint>((count_ + kStrips - 1) / kStrips);
  context_->launch(summarise_, kStrips, group_, boxes_, n(), strip, summaries_);
  std::array<Float4, kStrips * kSumsPerStrip> strips;
  context_->queue().enqueueReadBuffer(summaries_, CL_TRUE, 0, sizeof strips, strips.data());

  FrameSummary summary;
  std::copy_n(strips[0].begin(), 4, summary.bounds.min.begin());
  std::copy_n(strips[1].begin(), 4, summary.bounds.max.begin());
  const auto bodies = static_cast<double>(count_);
  std::array<double, 3> mean{};
  for (std::size_t s = 0; s < strips.size(); s += kSumsPerStrip) {
    summary.bounds = merged(summary.bounds, {strips[s], strips[s + 1]});
    summary.mean_edge += static_cast<double>(strips[s + 2][0]) / bodies;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      mean[axis] += static_cast<double>(strips[s + 3][axis]) / bodies;
      summary.variance[axis] += static_cast<double>(strips[s + 4][axis]) / bodies;
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) summary.variance[axis] -= mean[axis] * mean[axis];
  return summary;
}

void DeviceBroadPhase::visitSetup(const CounterVisitor& visit) const {
  visit("kernel_build_ns", static_cast<std::uint64_t>(context_->buildNanoseconds()));
}

}  // namespace broadmark::opencl
