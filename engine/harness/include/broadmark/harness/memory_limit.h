// How much memory this process may take.
#pragma once

#include <cstdint>
#include <optional>

namespace broadmark {

/// A line of /proc/self/status in bytes, such as "VmHWM"; nothing if there is no such line.
std::optional<std::uint64_t> statusBytes(const char* key);

/// Beyond so many bytes of its own this process, and what it starts, gets no memory
/// (std::bad_alloc). A lower limit that there is stays. `for_good`: nothing raises it again. Not in
/// builds with sanitizers, which hold terabytes from the start.
void limitMemory(std::uint64_t bytes, bool for_good);

/// What the machine has.
std::uint64_t machineMemory();

}  // namespace broadmark
