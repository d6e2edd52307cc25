// The OpenCL devices of this machine, for algorithms that run on one.
//
// Example:
//
//   const std::vector<ComputeDevice> devices = computeDevices();
//   if (!devices.empty()) {
//     const std::string text = describe(devices[chooseDevice(devices, "")]);  // the first one
//   }
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark {

/// A device as described by its driver.
struct ComputeDevice {
  std::string name;                ///< "NVIDIA H200"
  std::string platform;            ///< the driver's name: "Portable Computing Language"
  bool gpu = false;                ///< otherwise a CPU or another accelerator
  int units = 0;                   ///< parallel compute units; for a CPU, its threads
  std::uint64_t memory_bytes = 0;  ///< of global memory
  std::string driver;              ///< its version
};

/// All devices, GPUs first, otherwise in the order of the platforms. None without OpenCL, or if
/// Broadmark was built without it. Asks all drivers at each call, and loads them at the first.
std::vector<ComputeDevice> computeDevices();

/// A device in one line: name, platform, GPU or CPU, units, memory, driver.
std::string describe(const ComputeDevice&);

/// The index in `devices` of the requested one: `wanted` is its index, or a part of its name or
/// platform, ignoring case, of the first one that matches; "": the first. A number that is no index
/// counts as part of a name. Throws InputError that lists the devices.
std::size_t chooseDevice(const std::vector<ComputeDevice>& devices, std::string_view wanted);

}  // namespace broadmark
