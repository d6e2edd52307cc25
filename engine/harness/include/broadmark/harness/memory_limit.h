// Memory of this process, and its limits.
#pragma once

#include <cstdint>
#include <optional>

namespace broadmark {

/// A value of /proc/self/status in bytes, such as "VmHWM"; nullopt if there is none.
std::optional<std::uint64_t> statusBytes(const char* key);

/// Limits the private memory of this process and its children; beyond it, allocations fail
/// (std::bad_alloc). Never raises an existing limit. `permanent`: the limit cannot be raised
/// again. No effect in builds with sanitizers, which reserve terabytes from the start.
void limitMemory(std::uint64_t bytes, bool permanent);

std::uint64_t machineMemory();

/// Memory that this process has allocated and not freed.
std::uint64_t heapBytes();

}  // namespace broadmark
