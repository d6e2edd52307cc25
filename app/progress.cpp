// Progress on standard error.

#include "app/progress.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace broadmark {
namespace {

std::string duration(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

double seconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

constexpr const char* kEraseLine = "\r\033[K";

}  // namespace

Progress::Progress(std::string task, std::uint64_t steps, bool quiet)
    : task_(std::move(task)), steps_(steps), quiet_(quiet), terminal_(::isatty(2) != 0) {}

Progress::~Progress() {
  if (quiet_) return;
  fmt::print(stderr, "{}{}: {} ({})\n", terminal_ ? kEraseLine : "", task_,
             done_ >= steps_ ? "done" : fmt::format("stopped at {} of {}", done_, steps_),
             duration(seconds(Clock::now() - start_)));
}

void Progress::update(std::uint64_t done) {
  done_ = done;
  if (quiet_) return;
  // Often enough to look alive on a terminal; in a log, a sign of life now and then.
  const auto interval = terminal_ ? std::chrono::milliseconds(100) : std::chrono::seconds(15);
  const auto now = Clock::now();
  if (now - drawn_ < interval) return;
  draw(now);
}

void Progress::draw(Clock::time_point now) {
  drawn_ = now;
  const double share =
      static_cast<double>(done_) / static_cast<double>(std::max<std::uint64_t>(steps_, 1));
  const double left = share > 0 ? seconds(now - start_) * (1 - share) / share : 0;
  const std::string line =
      fmt::format("{}{}: {:.0f} %, about {} left", task_, detail_.empty() ? "" : " " + detail_,
                  100 * share, duration(left));
  fmt::print(stderr, "{}{}{}", terminal_ ? kEraseLine : "", line, terminal_ ? "" : "\n");
  std::fflush(stderr);
}

}  // namespace broadmark
