// The work never changes: times of different versions of Broadmark are compared by it.

#include "broadmark/harness/yardsticks.h"

#include <chrono>
#include <numeric>

namespace broadmark {
namespace {

using Clock = Yardsticks::Clock;

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

/// Reads one word of every line of the cache, in order: reads here and there would tell more of how
/// this process's pages lie than of the machine.
std::uint64_t read(const std::vector<std::uint32_t>& memory) {
  constexpr std::size_t kLine = 64 / sizeof(std::uint32_t);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < memory.size(); i += kLine) sum += memory[i];
  return sum;
}

template <class Work>
std::int64_t timeOf(Work&& work) {
  const auto begin = Clock::now();
  work();
  return std::chrono::nanoseconds(Clock::now() - begin).count();
}

}  // namespace

Yardsticks::Yardsticks() : memory_(kWords) { std::iota(memory_.begin(), memory_.end(), 0U); }

YardstickTimes Yardsticks::recent(Clock::time_point now) {
  // Many short repetitions must not take longer for this than for themselves.
  constexpr auto kFresh = std::chrono::milliseconds(30);
  if (!measured_ || now - *measured_ > kFresh) {
    times_ = measure();
    measured_ = Clock::now();
  }
  return times_;
}

YardstickTimes Yardsticks::measure() {
  YardstickTimes times;
  times[Yardstick::arithmetic] = timeOf([&] { sink_ += calculate(sink_); });
  times[Yardstick::memory] = timeOf([&] { sink_ += read(memory_); });
  return times;
}

}  // namespace broadmark
