// Selection among compute devices; opencl/device_context.cpp enumerates them.

#include "broadmark/compute_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>

#include "broadmark/error.h"

namespace broadmark {
namespace {

std::string listOf(const std::vector<ComputeDevice>& devices) {
  if (devices.empty()) return "there is none";
  std::string list = "there are";
  for (std::size_t i = 0; i < devices.size(); ++i) {
    list += fmt::format("{} {}: {}", i == 0 ? "" : ",", i, devices[i].name);
  }
  return list;
}

}  // namespace

std::string describe(const ComputeDevice& device) {
  constexpr double kGibibyte = 1 << 30;
  return fmt::format("{} ({}, {}, {} units, {:.1f} GiB, driver {})", device.name, device.platform,
                     device.gpu ? "GPU" : "CPU", device.units,
                     static_cast<double>(device.memory_bytes) / kGibibyte, device.driver);
}

std::size_t chooseDevice(const std::vector<ComputeDevice>& devices, std::string_view wanted) {
  if (wanted.empty() && !devices.empty()) return 0;
  std::size_t position = 0;
  const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), position);
  if (error == std::errc() && end == wanted.data() + wanted.size() && position < devices.size()) {
    return position;
  }
  const std::string part(wanted);
  const auto found = std::ranges::find_if(devices, [&](const ComputeDevice& device) {
    return ::strcasestr(device.name.c_str(), part.c_str()) != nullptr ||
           ::strcasestr(device.platform.c_str(), part.c_str()) != nullptr;
  });
  if (found == devices.end()) {
    throw InputError(fmt::format("no compute device '{}': {}", wanted, listOf(devices)));
  }
  return static_cast<std::size_t>(found - devices.begin());
}

}  // namespace broadmark
