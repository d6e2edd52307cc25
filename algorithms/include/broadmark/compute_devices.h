// The OpenCL devices of this machine, for algorithms that run on one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark {

/// A device as described by its driver.
struct ComputeDevice {
  std::string name;
  std::string platform;
  bool gpu = false;
  int units = 0;  ///< parallel compute units; for a CPU, its threads
  std::uint64_t memory_bytes = 0;
  std::string driver;
};

/// All devices, GPUs first, otherwise in the order of the platforms. None without OpenCL, or if
/// Broadmark was built without it.
std::vector<ComputeDevice> computeDevices();

/// A device in one line: name, platform, units, memory, driver.
std::string describe(const ComputeDevice&);

/// The index in `devices` of the requested one: `wanted` is its index, or a part of its name or
/// platform, ignoring case; "": the first. Throws InputError that lists the devices.
std::size_t chooseDevice(const std::vector<ComputeDevice>& devices, std::string_view wanted);

}  // namespace broadmark
