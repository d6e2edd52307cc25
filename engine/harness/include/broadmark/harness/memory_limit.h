// Memory limits of this process.
#pragma once

#include <cstdint>
#include <optional>

namespace broadmark {

/// A line of /proc/self/status in bytes, such as "VmHWM"; nothing if there is no such line.
std::optional<std::uint64_t> statusBytes(const char* key);

/// Limits the private memory of this process and its children; beyond it, allocations fail
/// (std::bad_alloc). Keeps a lower limit if there is one. `for_good`: the limit cannot be raised
/// again. No effect in builds with sanitizers, which reserve terabytes from the start.
void limitMemory(std::uint64_t bytes, bool for_good);

/// The machine's memory in bytes.
std::uint64_t machineMemory();

}  // namespace broadmark
