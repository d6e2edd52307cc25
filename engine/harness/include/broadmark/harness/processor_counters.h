// Hardware performance counters, where the system permits them, or instructions by valgrind.
//
// Example:
//
//   ProcessorCounters counters;
//   {
//     const ProcessorCounters::Counting counting(counters);
//     // the code to be counted
//   }
//   const ProcessorCounts counts = counters.counts();
//   const std::uint64_t instructions = counts[ProcessorCounter::instructions].value_or(0);
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
/// Holds a file descriptor per available counter.
class ProcessorCounters {
 public:
  /// A counter in the kernel's terms (perf_event_open).
  struct Event {
    std::uint32_t type = 0;    ///< perf_event_attr::type
    std::uint64_t config = 0;  ///< perf_event_attr::config
  };
  /// An event per ProcessorCounter, in its order.
  using Events = std::array<Event, kProcessorCounters.entries.size()>;

  /// Opens the counters, stopped, at zero. CounterSource::valgrind is only for a process started
  /// under callgrind, by WorkerOptions::valgrind: it truncates that process's descriptor 6.
  explicit ProcessorCounters(CounterSource source = CounterSource::processor);
  /// Substitute events, for tests on machines without access to the processor's counters.
  explicit ProcessorCounters(const Events& events);

  /// Counts during its lifetime, at most one at a time: the end of any stops the counters. Starting
  /// and stopping take a system call per counter.
  class Counting {
   public:
    /// `counters` must outlive it.
    explicit Counting(const ProcessorCounters& counters);
    ~Counting();
    Counting(const Counting&) = delete;
    Counting& operator=(const Counting&) = delete;

   private:
    const ProcessorCounters& counters_;
  };

  /// The next counts() start at zero.
  void restart();
  /// The counts during all Countings since restart() or the constructor; by valgrind, only those
  /// since the last counts(), if any. With more counters than hardware slots the kernel multiplexes
  /// them, and the counts are estimates.
  [[nodiscard]] ProcessorCounts counts() const;
  /// Whether the processor counts instructions for this process; tries it. False under valgrind.
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
