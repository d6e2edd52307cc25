// Hardware performance counters, where the system permits them, or instructions by valgrind.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "broadmark/files.h"
#include "broadmark/names.h"

namespace broadmark {

/// User-space counts only. Cache misses are those of the last level.
enum class ProcessorCounter { cycles, instructions, cache_misses, branches, branch_misses };
inline constexpr NameTable kProcessorCounters{{NamedValue{ProcessorCounter::cycles, "cycles"},
                                               {ProcessorCounter::instructions, "instructions"},
                                               {ProcessorCounter::cache_misses, "cache_misses"},
                                               {ProcessorCounter::branches, "branches"},
                                               {ProcessorCounter::branch_misses, "branch_misses"}}};

/// One count per counter; nullopt if unavailable.
using ProcessorCounts =
    ValueOfEach<ProcessorCounter, std::optional<std::uint64_t>, kProcessorCounters.entries.size()>;

/// What counts: the processor, or valgrind's tool callgrind, under which this process then runs.
/// callgrind counts only instructions, and only those of one thread.
enum class CounterSource { processor, valgrind };
inline constexpr NameTable kCounterSources{
    {NamedValue{CounterSource::processor, "processor"}, {CounterSource::valgrind, "valgrind"}}};

/// Counts for the creating thread, and for the threads that it starts afterwards. Most
/// virtual machines and containers forbid counting: then all counts are nullopt, without an error.
class ProcessorCounters {
 public:
  /// A counter in the kernel's terms (perf_event_open).
  struct Event {
    std::uint32_t type = 0;
    std::uint64_t config = 0;
  };
  using Events = std::array<Event, kProcessorCounters.entries.size()>;

  explicit ProcessorCounters(CounterSource source = CounterSource::processor);
  /// Substitute events, for tests on machines without access to the processor's counters.
  explicit ProcessorCounters(const Events& events);

  /// Counts during its lifetime.
  class Counting {
   public:
    explicit Counting(const ProcessorCounters& counters);
    ~Counting();
    Counting(const Counting&) = delete;
    Counting& operator=(const Counting&) = delete;

   private:
    const ProcessorCounters& counters_;
  };

  void restart();
  /// The counts since restart(). With more counters than hardware slots the kernel multiplexes
  /// them, and the counts are estimates.
  [[nodiscard]] ProcessorCounts counts() const;
  /// Whether the processor counts instructions for this process.
  static bool countInstructions();

 private:
  /// A raw count, with the time enabled and the time running.
  struct Reading {
    std::uint64_t count = 0;
    std::uint64_t enabled_ns = 0;
    std::uint64_t running_ns = 0;
  };
  struct Counter {
    FileDescriptor file;
    Reading before;
  };
  static FileDescriptor open(const Event& event);
  static std::optional<Reading> read(const Counter& counter);
  void controlAll(unsigned long request) const;

  CounterSource source_ = CounterSource::processor;
  std::array<Counter, kProcessorCounters.entries.size()> counters_;
};

}  // namespace broadmark
