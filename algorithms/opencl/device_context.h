// An initialised OpenCL device.
#pragma once

// Khronos's C++ bindings, configured as in all of Broadmark: OpenCL 1.2, errors as cl::Error.
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/execution.h"

namespace broadmark::opencl {

/// Adds its lifetime to `ns`.
class ScopedTimer {
 public:
  explicit ScopedTimer(std::int64_t& ns) : ns_(ns) {}
  ~ScopedTimer() { ns_ += std::chrono::nanoseconds(Clock::now() - start_).count(); }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  std::int64_t& ns_;
  Clock::time_point start_ = Clock::now();
};

/// Context and in-order queue on the requested device. On a CPU it uses only the execution
/// context's threads. Shared by all instances of an ExecutionContext: making a context and building
/// kernels takes far longer than a frame. Must outlive all objects made from it.
class DeviceContext final : public SharedResource {
 public:
  /// Throws UnsupportedError with the reason if there is no such device.
  explicit DeviceContext(ExecutionContext&);
  ~DeviceContext() override;
  DeviceContext(const DeviceContext&) = delete;
  DeviceContext& operator=(const DeviceContext&) = delete;

  [[nodiscard]] const cl::Device& device() const { return device_; }
  [[nodiscard]] const cl::Context& context() const { return context_; }
  [[nodiscard]] const cl::CommandQueue& queue() const { return queue_; }
  /// Whether the device is a CPU: few fast threads, no dedicated local memory.
  [[nodiscard]] bool onCpu() const { return on_cpu_; }

  /// Builds OpenCL C 1.2 kernels, or returns an earlier build. Throws UnsupportedError with the
  /// start of the compiler's log.
  cl::Program build(const std::string& source, const std::string& options = {});
  /// Total time of all builds.
  [[nodiscard]] std::int64_t buildNanoseconds() const { return build_ns_; }

  /// A buffer of at least one byte. Throws UnsupportedError when the device cannot hold it.
  [[nodiscard]] cl::Buffer buffer(std::size_t bytes) const;

  /// Runs a kernel with these arguments, in order, on `items` work items rounded up to whole groups
  /// of `group`. (The group size is explicit: otherwise PoCL recompiles a kernel for each guess.)
  template <class... Arguments>
  void launch(cl::Kernel& kernel, std::size_t items, std::size_t group,
              const Arguments&... arguments) const {
    cl_uint position = 0;
    (kernel.setArg(position++, arguments), ...);
    const std::size_t groups = (items + group - 1) / group;
    if (groups > 0) {
      queue_.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(groups * group),
                                  cl::NDRange(group));
    }
  }

 private:
  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  bool on_cpu_ = false;
  std::int64_t build_ns_ = 0;
  std::map<std::pair<std::string, std::string>, cl::Program> programs_;  ///< by source and options
};

}  // namespace broadmark::opencl
