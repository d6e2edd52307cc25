// Listing algorithms that run on a compute device.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "broadmark/algorithm.h"

namespace broadmark::opencl {

/// What one algorithm on a device has of its own.
struct DeviceVariant {
  std::uint64_t max_objects = 0;
  std::string exclusive = {};
  std::function<std::unique_ptr<BroadPhase>()> create;
};

/// The entry of an algorithm on a device. All are linear in space, and drivers allocate.
inline Algorithm deviceAlgorithm(std::string id, std::string summary,
                                 AlgorithmDescription description, DeviceVariant own) {
  description.space = "O(n + k)";
  return {.id = std::move(id),
          .family = "GPU",
          .summary = std::move(summary),
          .traits = {.parallel = true,
                     .on_device = true,
                     .library_allocates = true,
                     .changing_worlds = ChangingWorlds::compacted,
                     .max_objects = own.max_objects,
                     .exclusive = std::move(own.exclusive)},
          .description = std::move(description),
          .create = std::move(own.create)};
}

}  // namespace broadmark::opencl
