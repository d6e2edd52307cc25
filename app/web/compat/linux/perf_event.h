// Opening an event fails: see missing.h.
#pragma once

#include <cstdint>

struct perf_event_attr {
  unsigned size, type;
  std::uint64_t config, read_format;
  unsigned disabled, inherit, exclude_kernel, exclude_hv;
};
enum { PERF_TYPE_HARDWARE, PERF_TYPE_SOFTWARE };
enum {
  PERF_COUNT_HW_CPU_CYCLES,
  PERF_COUNT_HW_INSTRUCTIONS,
  PERF_COUNT_HW_CACHE_MISSES,
  PERF_COUNT_HW_BRANCH_INSTRUCTIONS,
  PERF_COUNT_HW_BRANCH_MISSES
};
enum { PERF_FORMAT_TOTAL_TIME_ENABLED = 1, PERF_FORMAT_TOTAL_TIME_RUNNING = 2 };
enum { PERF_FLAG_FD_CLOEXEC = 8 };
enum { PERF_EVENT_IOC_RESET, PERF_EVENT_IOC_ENABLE, PERF_EVENT_IOC_DISABLE };
