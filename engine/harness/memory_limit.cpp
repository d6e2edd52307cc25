// RLIMIT_DATA limits private writable memory. Unlike RLIMIT_AS it excludes memory that a graphics
// driver or a library merely maps.

#include "broadmark/harness/memory_limit.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace broadmark {

std::optional<std::uint64_t> statusBytes(const char* key) {
  std::ifstream status("/proc/self/status");
  const std::string begin = std::string(key) + ":";
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(begin)) return std::stoull(line.substr(begin.size())) * 1024;
  }
  return std::nullopt;
}

void limitMemory(std::uint64_t bytes, bool permanent) {
  if (bytes == 0 || statusBytes("VmData").value_or(0) > bytes) return;
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(bytes, permanent ? limit.rlim_max : limit.rlim_cur);
  if (permanent) limit.rlim_max = limit.rlim_cur;
  ::setrlimit(RLIMIT_DATA, &limit);
}

std::uint64_t machineMemory() {
  return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::uint64_t heapBytes() {
  const auto heap = ::mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

}  // namespace broadmark
