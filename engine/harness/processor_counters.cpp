// Linux performance events, each with a descriptor. They form no group: a group counts only while
// the processor has slots for all its events, and its counts do not include child threads.

#include "broadmark/harness/processor_counters.h"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cmath>

#include "callgrind.h"

namespace broadmark {
namespace {

constexpr ProcessorCounters::Events kHardware = {{
    {PERF_TYPE_HARDWARE, PERF_COUNT_HW_CPU_CYCLES},
    {PERF_TYPE_HARDWARE, PERF_COUNT_HW_INSTRUCTIONS},
    {PERF_TYPE_HARDWARE, PERF_COUNT_HW_CACHE_MISSES},
    {PERF_TYPE_HARDWARE, PERF_COUNT_HW_BRANCH_INSTRUCTIONS},
    {PERF_TYPE_HARDWARE, PERF_COUNT_HW_BRANCH_MISSES},
}};

}  // namespace

FileDescriptor ProcessorCounters::open(const Event& event) {
  perf_event_attr attributes{};
  attributes.size = sizeof attributes;
  attributes.type = event.type;
  attributes.config = event.config;
  attributes.disabled = 1;
  attributes.inherit = 1;
  attributes.exclude_kernel = 1;  // unprivileged users may count user space only, if anything
  attributes.exclude_hv = 1;
  attributes.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
  constexpr int kThisThread = 0;
  constexpr int kAnyCore = -1;
  constexpr int kNoGroup = -1;
  return FileDescriptor(static_cast<int>(::syscall(SYS_perf_event_open, &attributes, kThisThread,
                                                   kAnyCore, kNoGroup, PERF_FLAG_FD_CLOEXEC)));
}

ProcessorCounters::ProcessorCounters(CounterSource source) : source_(source) {
  // Under valgrind the events would be those of valgrind itself.
  if (source == CounterSource::valgrind || callgrind::isRunning()) return;
  for (std::size_t i = 0; i < kHardware.size(); ++i) counters_[i].file = open(kHardware[i]);
}

ProcessorCounters::ProcessorCounters(const Events& events) {
  for (std::size_t i = 0; i < events.size(); ++i) counters_[i].file = open(events[i]);
}

std::optional<ProcessorCounters::Reading> ProcessorCounters::read(const Counter& counter) {
  Reading reading;  // layout of the kernel's read_format
  static_assert(sizeof reading == 3 * sizeof(std::uint64_t));
  if (counter.file.get() < 0) return std::nullopt;
  if (::read(counter.file.get(), &reading, sizeof reading) != sizeof reading) return std::nullopt;
  return reading;
}

bool ProcessorCounters::countInstructions() {
  ProcessorCounters probe;
  probe.restart();
  {
    const Counting counting(probe);
  }
  return probe.counts()[ProcessorCounter::instructions].value_or(0) > 0;
}

void ProcessorCounters::controlAll(unsigned long request) const {
  for (const Counter& counter : counters_) {
    if (counter.file.get() >= 0) ::ioctl(counter.file.get(), request, 0);
  }
}

ProcessorCounters::Counting::Counting(const ProcessorCounters& counters) : counters_(counters) {
  if (counters_.source_ == CounterSource::valgrind) {
    callgrind::start();
  } else {
    counters_.controlAll(PERF_EVENT_IOC_ENABLE);
  }
}

ProcessorCounters::Counting::~Counting() {
  if (counters_.source_ == CounterSource::valgrind) {
    callgrind::stop();
  } else {
    counters_.controlAll(PERF_EVENT_IOC_DISABLE);
  }
}

void ProcessorCounters::restart() {
  if (source_ == CounterSource::valgrind) callgrind::takeInstructions();
  for (Counter& counter : counters_) counter.before = read(counter).value_or(Reading());
}

ProcessorCounts ProcessorCounters::counts() const {
  ProcessorCounts counts;
  if (source_ == CounterSource::valgrind) {
    counts[ProcessorCounter::instructions] = callgrind::takeInstructions();
    return counts;
  }
  for (std::size_t i = 0; i < counters_.size(); ++i) {
    const std::optional<Reading> now = read(counters_[i]);
    if (!now) continue;
    const Reading& before = counters_[i].before;
    const auto enabled = static_cast<double>(now->enabled_ns - before.enabled_ns);
    const auto running = static_cast<double>(now->running_ns - before.running_ns);
    const std::uint64_t count = now->count - before.count;
    if (enabled == running) {
      counts.values[i] = count;
    } else if (running > 0) {
      counts.values[i] = static_cast<std::uint64_t>(
          std::llround(static_cast<double>(count) * (enabled / running)));
    }
  }
  return counts;
}

}  // namespace broadmark
