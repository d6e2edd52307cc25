// A signal handler can only set a global.

#include "support/interrupt.h"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace broadmark {
namespace {

// When the first signal came; 0: none did. Several threads read it, and any of them may be
// interrupted by the signal.
std::atomic<std::int64_t> first_at_ns = 0;
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "a signal handler must not wait");

std::int64_t nowNs() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void onSignal(int signal) {
  // timeout(1) signals a process and its group: two signals at once are one wish.
  constexpr std::int64_t kAtOnceNs = 300'000'000;
  const std::int64_t now = nowNs();
  std::int64_t first = 0;
  if (first_at_ns.compare_exchange_strong(first, now) || now - first < kAtOnceNs) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  first_at_ns = 0;
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool InterruptGuard::requested() { return first_at_ns != 0; }

}  // namespace broadmark
