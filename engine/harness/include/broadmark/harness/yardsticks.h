// Two small fixed pieces of work, timed between repetitions: how fast the machine was just then.
// Where two runs are compared, what these differ by is not the algorithms' doing.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
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
struct YardstickTimes {
  std::array<std::int64_t, kYardsticks.entries.size()> ns{};

  std::int64_t& operator[](Yardstick which) { return ns[static_cast<std::size_t>(which)]; }
  std::int64_t operator[](Yardstick which) const { return ns[static_cast<std::size_t>(which)]; }
};

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
