// Two small fixed pieces of work, timed between repetitions: how fast the machine was just then.
// Where two runs are compared, what these differ by is not the algorithms' doing.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "broadmark/names.h"

namespace broadmark {

/// What bounds the work: arithmetic in registers, or reading more memory than the caches of one
/// core hold.
enum class Yardstick { arithmetic, memory };
inline constexpr NameTable kYardsticks{
    {NamedValue{Yardstick::arithmetic, "arithmetic"}, {Yardstick::memory, "memory"}}};

/// Nanoseconds of each.
using YardstickTimes = ValueOfEach<Yardstick, std::int64_t, kYardsticks.entries.size()>;

class Yardsticks {
 public:
  using Clock = std::chrono::steady_clock;

  Yardsticks();
  /// A time of each: measured now, which takes about 3 ms, or within the last 30 ms. One alone says
  /// little; of many the least is how fast the machine can be.
  YardstickTimes recent(Clock::time_point now = Clock::now());

 private:
  YardstickTimes measure();

  std::optional<Clock::time_point> measured_;
  YardstickTimes times_;
  std::vector<std::uint32_t> memory_;
  std::uint64_t sink_ = 0;  ///< what was computed, so that it is
};

}  // namespace broadmark
