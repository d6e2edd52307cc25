// Progress of long work, with an estimate of the time left.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace broadmark {

/// Shows on standard error how far a task is. On a terminal one line is rewritten; elsewhere each
/// task gets a plain line when it ends. Shows nothing when `quiet`.
class Progress {
 public:
  Progress(std::string task, std::uint64_t steps, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Names what is being done now.
  void detail(std::string text) { detail_ = std::move(text); }
  /// `done` of the steps are done.
  void update(std::uint64_t done);
  void step() { update(done_ + 1); }

 private:
  using Clock = std::chrono::steady_clock;
  void draw(Clock::time_point now);

  std::string task_;
  std::string detail_;
  std::uint64_t steps_;
  std::uint64_t done_ = 0;
  bool quiet_;
  bool terminal_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_ = start_;
};

}  // namespace broadmark
