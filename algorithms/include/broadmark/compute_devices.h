// The OpenCL devices of this machine, for algorithms that run on one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark {

/// A device as its driver describes it.
struct ComputeDevice {
  std::string name;
  std::string platform;
  bool gpu = false;
  int units = 0;  ///< parallel compute units; of a CPU, its threads
  std::uint64_t memory_bytes = 0;
  std::string driver;
};

/// All of them, GPUs first, else in the order of the platforms. None where there is no OpenCL, or
/// where Broadmark was built without.
std::vector<ComputeDevice> computeDevices();

/// A device in one line: name, platform, units, memory, driver.
std::string describe(const ComputeDevice&);

/// The position in `devices` of the wanted one: `wanted` is its position, or a part of its name or
/// platform in any case; "": the first. Throws InputError that lists the devices.
std::size_t chooseDevice(const std::vector<ComputeDevice>& devices, std::string_view wanted);

}  // namespace broadmark
