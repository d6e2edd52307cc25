// An OpenCL device made ready for one run.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/opencl/opencl.h"
#include "broadmark/execution.h"

namespace broadmark::opencl {

/// The devices in the order of computeDevices().
std::vector<cl::Device> devices();

/// Context and in-order queue on the wanted device. On a CPU it uses the execution's threads only.
class DeviceContext {
 public:
  /// Throws UnsupportedError that says why there is no such device.
  explicit DeviceContext(const Execution&);

  [[nodiscard]] const cl::Device& device() const { return device_; }
  [[nodiscard]] const cl::Context& context() const { return context_; }
  [[nodiscard]] const cl::CommandQueue& queue() const { return queue_; }
  /// Whether the device is a CPU: few fast threads, no local memory of its own.
  [[nodiscard]] bool onCpu() const { return on_cpu_; }

  /// Builds OpenCL C 1.2 kernels. Throws UnsupportedError with the start of the compiler's log.
  cl::Program build(std::string_view source, const std::string& options = {});
  /// Time that all builds took so far.
  [[nodiscard]] std::int64_t buildNanoseconds() const { return build_ns_; }

  /// A buffer of at least one byte. Throws UnsupportedError when the device cannot hold it.
  [[nodiscard]] cl::Buffer buffer(std::size_t bytes, cl_mem_flags flags = CL_MEM_READ_WRITE) const;

 private:
  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  bool on_cpu_ = false;
  std::int64_t build_ns_ = 0;
};

}  // namespace broadmark::opencl
