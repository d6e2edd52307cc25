// Shared base of the algorithms on a compute device: uploads boxes, downloads pairs, and retains
// growing buffers for both.
#pragma once

#include <optional>
#include <string_view>

#include "opencl/device_algorithm.h"
#include "opencl/device_context.h"
#include "opencl/device_sorter.h"

namespace broadmark::opencl {

/// Bounds, mean size and spread of a frame's boxes.
struct FrameSummary {
  Aabb bounds;
  double mean_edge = 0;              ///< mean of the bodies' longest edges
  std::array<double, 3> variance{};  ///< of the centres, per axis
};

/// The output of a search kernel: its last three arguments.
struct PairSink {
  cl::Buffer pairs;
  cl::Buffer count;
  cl_uint capacity = 0;
};

/// As in common.cl: padding bodies at the end, which overlap nothing.
constexpr std::size_t kPadding = 16;

/// Waits for the device at the end of each phase, so that times are correct. Directly on
/// BroadPhase: the device returns the whole answer, and workers fill no pair buffers.
class DeviceBroadPhase : public BroadPhase {
 public:
  void visitParameters(const ParameterVisitor&) override;

  void initialize(const SceneInfo&, const Frame& first, ExecutionContext&) final;
  void updateObjects(const Frame& frame) final;
  void cleanCache() final;
  void updateStructures() final;
  void searchOverlaps() final;

  [[nodiscard]] PairRuns overlaps() const final { return {&run_, 1}; }
  [[nodiscard]] TransferTimes transfers() const final { return transfers_; }
  void visitSetup(const CounterVisitor&) const final;

 protected:
  // To be implemented. reserve(), build() and search() are called with at least two bodies.

  /// The kernels' source, appended to common.cl.
  [[nodiscard]] virtual std::string_view kernelSource() const = 0;
  virtual void makeKernels(const cl::Program&) = 0;
  /// Makes buffers for `count` bodies; called when the maximum grows.
  virtual void reserve(std::size_t count) = 0;
  /// Enqueues building the structure from boxes().
  virtual void build() = 0;
  /// Enqueues the search. May be called again, with a larger sink.
  virtual void search(const PairSink&) = 0;

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] cl_uint n() const { return static_cast<cl_uint>(count_); }
  /// Bodies' boxes, as Aabb.
  [[nodiscard]] const cl::Buffer& boxes() const { return boxes_; }
  DeviceSorter& sorter() { return *sorter_; }
  DeviceContext& context() { return *context_; }
  [[nodiscard]] const DeviceContext& context() const { return *context_; }

  /// Enqueues a kernel with the work items that FOR_EACH_BODY needs for `bodies`.
  template <class... Arguments>
  void forBodies(cl::Kernel& kernel, std::size_t bodies, const Arguments&... arguments) {
    const std::size_t items = (bodies + bodies_per_item_ - 1) / bodies_per_item_;
    context_->launch(kernel, items, group_, arguments...);
  }

  /// Whether a work item processes one body, for a GPU. Else hundreds, sixteen at a time.
  [[nodiscard]] bool likeGpu() const;

  /// Length of each of the six arrays of sorted boxes, and a buffer for all of them (see
  /// common.cl).
  [[nodiscard]] cl_uint stride() const { return static_cast<cl_uint>(count_ + kPadding); }
  [[nodiscard]] cl::Buffer sortedBoxes(std::size_t count) const {
    return context_->buffer(6 * (count + kPadding) * sizeof(float));
  }

  /// Summarises all boxes; waits for the result.
  FrameSummary summarise();

  /// Reads a buffer of `size` elements back: for drawing and checks, not within a phase.
  template <class T>
  [[nodiscard]] std::vector<T> read(const cl::Buffer& buffer, std::size_t size) const {
    std::vector<T> elements(size);
    if (size > 0) {
      context_->queue().enqueueReadBuffer(buffer, CL_TRUE, 0, size * sizeof(T), elements.data());
    }
    return elements;
  }

 private:
  void makeProgram();
  cl_uint searchOnce();

  Choice work_division_{"auto", {"auto", "cpu", "gpu"}};
  DeviceContext* context_ = nullptr;  ///< the execution's
  std::optional<DeviceSorter> sorter_;
  std::size_t bodies_per_item_ = 1;
  std::size_t group_ = 1;
  cl::Kernel summarise_;
  cl::Buffer summaries_;
  std::size_t count_ = 0;
  std::size_t capacity_ = 0;  ///< bodies that all buffers have room for
  cl::Buffer boxes_;
  PairSink sink_;
  PairBuffer pairs_;
  PairRun run_;
  TransferTimes transfers_;
};

}  // namespace broadmark::opencl
