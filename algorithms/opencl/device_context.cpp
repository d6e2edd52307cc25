#include "opencl/device_context.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "broadmark/compute_devices.h"
#include "broadmark/error.h"

namespace broadmark {
namespace opencl {
namespace {

/// Fills a vector by get(); empty on failure: no ICD is installed, or a platform has no device.
template <class Found, class Get>
std::vector<Found> foundBy(Get get) {
  std::vector<Found> found;
  try {
    get(&found);
  } catch (const cl::Error&) {
    found.clear();
  }
  return found;
}

std::vector<cl::Platform> platforms() {
  return foundBy<cl::Platform>([](auto* found) { cl::Platform::get(found); });
}

bool isGpu(const cl::Device& device) {
  return (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) != 0;
}

/// Without the NULs and blanks that drivers add.
std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
  text.erase(0, text.find_first_not_of(' '));
  return text;
}

std::string whyNone() {
  const auto found = platforms();
  if (found.empty()) return "no OpenCL platform is installed";
  return fmt::format("the OpenCL platform '{}' has no device (PoCL: is its kernel cache writable?)",
                     trimmed(found.front().getInfo<CL_PLATFORM_NAME>()));
}

/// A sub-device of a CPU with that many threads; the whole CPU if it has no more.
cl::Device withThreads(cl::Device device, int threads) {
  const auto units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  if (static_cast<cl_uint>(threads) >= units) return device;
  const cl_device_partition_property by_counts[] = {CL_DEVICE_PARTITION_BY_COUNTS, threads,
                                                    CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
  std::vector<cl::Device> parts;
  try {
    device.createSubDevices(by_counts, &parts);
  } catch (const cl::Error& error) {
    throw UnsupportedError(fmt::format("cannot limit {} to {} of its {} threads (OpenCL error {})",
                                       trimmed(device.getInfo<CL_DEVICE_NAME>()), threads, units,
                                       error.err()));
  }
  return parts.front();
}

/// In the order of computeDevices().
std::vector<cl::Device> devices() {
  std::vector<cl::Device> all;
  for (const cl::Platform& platform : platforms()) {
    const auto get = [&](auto* found) { platform.getDevices(CL_DEVICE_TYPE_ALL, found); };
    std::ranges::move(foundBy<cl::Device>(get), std::back_inserter(all));
  }
  std::ranges::stable_partition(all, isGpu);
  return all;
}

}  // namespace

DeviceContext::DeviceContext(ExecutionContext& execution) {
  const std::vector<ComputeDevice> known = computeDevices();
  if (known.empty()) throw UnsupportedError(whyNone());
  try {
    const std::size_t chosen = chooseDevice(known, execution.device());
    device_ = devices().at(chosen);
    on_cpu_ = !known[chosen].gpu;
    if (on_cpu_) device_ = withThreads(device_, execution.threads());
    context_ = cl::Context(device_);
    queue_ = cl::CommandQueue(context_, device_);
  } catch (const InputError& error) {
    throw UnsupportedError(error.what());
  } catch (const cl::Error& error) {
    throw UnsupportedError(fmt::format("{} fails (OpenCL error {})", error.what(), error.err()));
  }
}

// PoCL 3.1 reports a command as done before it releases the command's event. The event holds the
// queue, which uses the device without holding it. So a sub-device is freed only once no event
// holds the queue.
DeviceContext::~DeviceContext() {
  constexpr auto kPatience = std::chrono::seconds(1);  // others may hold references
  if (!on_cpu_ || queue_() == nullptr) return;
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  const auto is_held = [this] {
    cl_uint count = 0;  // the C interface, as the C++ one may throw
    ::clGetCommandQueueInfo(queue_(), CL_QUEUE_REFERENCE_COUNT, sizeof count, &count, nullptr);
    return count > 1;
  };
  while (is_held() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
}

cl::Program DeviceContext::build(const std::string& source, const std::string& options) {
  constexpr std::size_t kLogShown = 1000;
  const auto known = programs_.find({source, options});
  if (known != programs_.end()) return known->second;
  const ScopedTimer timer(build_ns_);
  cl::Program program(context_, source);
  try {
    // -w: otherwise PoCL prints the number of warnings on standard error. `./check --kernels` shows
    // them.
    program.build(device_, ("-w -cl-std=CL1.2 " + options).c_str());
  } catch (const cl::Error& error) {
    std::string log = trimmed(program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device_));
    std::ranges::replace(log, '\n', ' ');
    throw UnsupportedError(fmt::format("kernels do not build (OpenCL error {}): {}", error.err(),
                                       log.substr(0, kLogShown)));
  }
  programs_.emplace(std::pair(source, options), program);
  return program;
}

cl::Buffer DeviceContext::buffer(std::size_t bytes) const {
  const auto largest = device_.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  if (bytes > largest) {
    throw UnsupportedError(fmt::format("the device's largest buffer is {} MiB, {} MiB are needed",
                                       largest >> 20, bytes >> 20));
  }
  return {context_, CL_MEM_READ_WRITE, std::max<std::size_t>(bytes, 1)};
}

}  // namespace opencl

std::vector<ComputeDevice> computeDevices() {
  std::vector<ComputeDevice> known;
  for (const cl::Device& device : opencl::devices()) {
    const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
    known.push_back({.name = opencl::trimmed(device.getInfo<CL_DEVICE_NAME>()),
                     .platform = opencl::trimmed(platform.getInfo<CL_PLATFORM_NAME>()),
                     .gpu = opencl::isGpu(device),
                     .units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>()),
                     .memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>(),
                     .driver = opencl::trimmed(device.getInfo<CL_DRIVER_VERSION>())});
  }
  return known;
}

}  // namespace broadmark
