// The work never changes: times of different versions of Broadmark are compared by it.

#include "broadmark/yardsticks.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>

namespace broadmark {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTakes = 5;
constexpr std::size_t kWords = std::size_t{8} << 20;  // 32 MiB

/// Eight independent chains, to keep the units of a core busy.
std::uint64_t calculate(std::uint64_t seed) {
  std::array<std::uint64_t, 8> chains{};
  std::iota(chains.begin(), chains.end(), seed);
  for (int step = 0; step < 200'000; ++step) {
    for (std::uint64_t& chain : chains) chain = chain * 6364136223846793005U + 1442695040888963407U;
  }
  return std::accumulate(chains.begin(), chains.end(), std::uint64_t{0});
}

/// Reads a line of the cache here and there; the places do not depend on what was read.
std::uint64_t read(const std::vector<std::uint32_t>& memory, std::uint64_t seed) {
  constexpr int kReads = 100'000;
  std::uint64_t place = seed | 1;
  std::uint64_t sum = 0;
  for (int i = 0; i < kReads; ++i) {
    place = place * 6364136223846793005U + 1442695040888963407U;
    sum += memory[(place >> 33) % kWords];
  }
  return sum;
}

template <class Work>
std::int64_t leastTime(Work&& work) {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (int take = 0; take < kTakes; ++take) {
    const auto begin = Clock::now();
    work();
    least = std::min(least, std::chrono::nanoseconds(Clock::now() - begin).count());
  }
  return least;
}

}  // namespace

Yardsticks::Yardsticks() : memory_(kWords) { std::iota(memory_.begin(), memory_.end(), 0U); }

YardstickTimes Yardsticks::recent() {
  // Many short repetitions must not take longer for this than for themselves.
  constexpr auto kFresh = std::chrono::milliseconds(250);
  if (!measured_ || Clock::now() - *measured_ > kFresh) {
    times_ = measure();
    measured_ = Clock::now();
  }
  return times_;
}

YardstickTimes Yardsticks::measure() {
  // Each take depends on the last one's result, or the compiler would see that they are the same.
  YardstickTimes times;
  times[Yardstick::arithmetic] = leastTime([&] { sink_ += calculate(sink_); });
  times[Yardstick::memory] = leastTime([&] { sink_ += read(memory_, sink_); });
  return times;
}

}  // namespace broadmark
