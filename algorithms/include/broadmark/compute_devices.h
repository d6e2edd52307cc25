// The OpenCL devices of this machine, for algorithms that run on one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark {

/// What is known of a device before it is used.
struct ComputeDevice {
  std::string name;
  std::string platform;
  bool gpu = false;
  int units = 0;  ///< parallel compute units; of a CPU, its threads
  std::uint64_t memory_bytes = 0;
  std::uint64_t largest_buffer_bytes = 0;
  std::string driver;
};

/// All of them, GPUs first, else in the order of the platforms. None where there is no OpenCL, or
/// where Broadmark was built without.
std::vector<ComputeDevice> computeDevices();

/// A device in one line: name, platform, units, memory, driver.
std::string describe(const ComputeDevice&);

/// The position in `devices` of the one that is meant: by its position, or by a part of its name or
/// platform, any case; the first when `wanted` is "". Throws InputError that lists what there is.
std::size_t chooseDevice(const std::vector<ComputeDevice>& devices, std::string_view wanted);

}  // namespace broadmark
