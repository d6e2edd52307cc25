// Registry entries of algorithms on a compute device.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "broadmark/algorithm.h"

namespace broadmark::opencl {

/// Kernels index sixteen floats for each body with 32 bits.
constexpr std::uint64_t kMaxObjectCount = std::uint64_t{1} << 28;

/// The entry of an algorithm on a device. All are linear in space, and drivers allocate.
template <class Phase>
Algorithm deviceAlgorithm(std::string id, std::string summary, AlgorithmDescription description,
                          std::uint64_t max_objects = kMaxObjectCount, std::string exclusive = {}) {
  description.space = "O(n + k)";
  return {.id = std::move(id),
          .family = "GPU",
          .summary = std::move(summary),
          .traits = {.parallel = true,
                     .on_device = true,
                     .library_allocates = true,
                     .changing_worlds = ChangingWorlds::compacted,
                     .max_objects = max_objects,
                     .exclusive = std::move(exclusive)},
          .description = std::move(description),
          .create = [] { return std::make_unique<Phase>(); }};
}

}  // namespace broadmark::opencl
