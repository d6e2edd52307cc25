// What the processor itself counts while a case runs, as far as the system lets us see it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "broadmark/files.h"
#include "broadmark/names.h"

namespace broadmark {

/// Of the program, without the system's part. Cache misses are those of the last level.
enum class ProcessorCounter { cycles, instructions, cache_misses, branches, branch_misses };
inline constexpr NameTable kProcessorCounters{{NamedValue{ProcessorCounter::cycles, "cycles"},
                                               {ProcessorCounter::instructions, "instructions"},
                                               {ProcessorCounter::cache_misses, "cache_misses"},
                                               {ProcessorCounter::branches, "branches"},
                                               {ProcessorCounter::branch_misses, "branch_misses"}}};

/// One count of each; nothing where it is not known.
using ProcessorCounts =
    ValueOfEach<ProcessorCounter, std::optional<std::uint64_t>, kProcessorCounters.entries.size()>;

/// Counts what the thread that made it does, and the threads that this one starts afterwards.
/// Most virtual machines and containers do not allow it: then nothing is known, which is no error.
class ProcessorCounters {
 public:
  /// What to count, in the kernel's numbers (perf_event_open).
  struct Event {
    std::uint32_t type = 0;
    std::uint64_t config = 0;
  };
  using Events = std::array<Event, kProcessorCounters.entries.size()>;

  /// Those of the processor.
  ProcessorCounters();
  /// Other ones in their places, for tests on machines whose processor's are not to be had.
  explicit ProcessorCounters(const Events& events);

  /// Counts as long as it lives.
  class Counting {
   public:
    explicit Counting(const ProcessorCounters& counters);
    ~Counting();
    Counting(const Counting&) = delete;
    Counting& operator=(const Counting&) = delete;

   private:
    const ProcessorCounters& counters_;
  };

  /// Begins anew from zero.
  void restart();
  /// What was counted since. With more counters than the processor has at a time, they take turns,
  /// and these are estimates.
  [[nodiscard]] ProcessorCounts counts() const;

 private:
  /// The count, and for how long it was wanted and done.
  struct Reading {
    std::uint64_t count = 0;
    std::uint64_t wanted_ns = 0;
    std::uint64_t done_ns = 0;
  };
  struct Counter {
    FileDescriptor file;
    Reading before;
  };
  static FileDescriptor open(const Event& event);
  static std::optional<Reading> read(const Counter& counter);
  void tellAll(unsigned long request) const;

  std::array<Counter, kProcessorCounters.entries.size()> counters_;
};

}  // namespace broadmark
