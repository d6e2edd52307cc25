// Progress on standard error.

#include "support/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "support/interrupt.h"
#include "support/words.h"

namespace broadmark {
namespace {

double seconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

constexpr const char* kEraseLine = "\r\033[K";

/// Number of columns of the terminal on standard error.
std::size_t terminalWidth() {
  winsize size{};
  constexpr std::size_t kDefaultWidth = 80;
  return ::ioctl(2, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kDefaultWidth;
}

/// Truncates a text to at most `bytes`, with dots at its end if it was longer.
std::string shortened(const std::string& text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  std::size_t end = bytes > 3 ? bytes - 3 : 0;
  // Never split a UTF-8 character.
  while (end > 0 && (text[end] & 0xC0) == 0x80) --end;
  return text.substr(0, end) + std::string(std::min<std::size_t>(bytes, 3), '.');
}

}  // namespace

Progress::Progress(std::string task, std::uint64_t steps, bool quiet)
    : task_(std::move(task)), steps_(steps), quiet_(quiet), terminal_(::isatty(2) != 0) {}

Progress::~Progress() {
  if (quiet_) return;
  // An interrupted task is not done, however far it got.
  const bool is_complete = done_ >= steps_ && !InterruptGuard::requested();
  const double share =
      static_cast<double>(done_) / static_cast<double>(std::max<std::uint64_t>({steps_, done_, 1}));
  fmt::print(stderr, "{}{}: {} ({})\n", terminal_ ? kEraseLine : "", task_,
             is_complete ? "done" : fmt::format("stopped at {:.0f} %", std::floor(100 * share)),
             waitingTime(seconds(Clock::now() - start_)));
}

void Progress::update(std::uint64_t done) {
  done_ = done;
  if (!isDue()) return;
  const double elapsed = seconds(Clock::now() - start_);
  const double left_per_done = static_cast<double>(steps_ - std::min(done, steps_)) /
                               static_cast<double>(std::max<std::uint64_t>(done, 1));
  draw(elapsed * left_per_done);
}

void Progress::update(std::uint64_t done, double seconds_left) {
  done_ = done;
  if (isDue()) draw(seconds_left);
}

void Progress::print(std::FILE* stream, std::string_view line) {
  if (terminal_ && !quiet_) {
    fmt::print(stderr, "{}", kEraseLine);
    std::fflush(stderr);
  }
  fmt::print(stream, "{}\n", line);
  std::fflush(stream);
}

bool Progress::isDue() const {
  // Frequent updates on a terminal, few lines in a log.
  const auto interval = terminal_ ? std::chrono::milliseconds(100) : std::chrono::seconds(15);
  return !quiet_ && Clock::now() - drawn_ >= interval;
}

void Progress::draw(double seconds_left) {
  drawn_ = Clock::now();
  const double share =
      static_cast<double>(done_) / static_cast<double>(std::max<std::uint64_t>(steps_, 1));
  // No estimate before the first step.
  const std::string left =
      done_ == 0 ? "" : fmt::format(", about {} left", waitingTime(seconds_left));
  const std::string state = fmt::format(": {:.0f} %{}", 100 * share, left);
  std::string text = task_ + (detail_.empty() ? "" : " " + detail_);
  if (terminal_) {
    // A wrapped line could not be erased.
    const std::size_t width = terminalWidth() - 1;
    text = shortened(text, width > state.size() ? width - state.size() : 0);
    fmt::print(stderr, "{}{}{}", kEraseLine, text, state);
  } else {
    fmt::print(stderr, "{}{}\n", text, state);
  }
  std::fflush(stderr);
}

}  // namespace broadmark
