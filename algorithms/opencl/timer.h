// Adds up durations in nanoseconds.
#pragma once

#include <chrono>
#include <cstdint>

namespace broadmark::opencl {

/// Adds the time of its own life to `ns`.
class ScopedTimer {
 public:
  explicit ScopedTimer(std::int64_t& ns) : ns_(ns) {}
  ~ScopedTimer() { ns_ += std::chrono::nanoseconds(Clock::now() - start_).count(); }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  std::int64_t& ns_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace broadmark::opencl
