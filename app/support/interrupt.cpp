// The signal handler only sets a global variable.

#include "support/interrupt.h"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace broadmark {
namespace {

// Time of the first signal; 0: none. Several threads read it, and the signal may interrupt any.
std::atomic<std::int64_t> first_signal_ns = 0;
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "a signal handler must not wait");

std::int64_t nowNs() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void onSignal(int signal) {
  // timeout(1) signals a process and its group: simultaneous signals are a single request.
  constexpr std::int64_t kSimultaneousNs = 300'000'000;
  const std::int64_t now = nowNs();
  std::int64_t first = 0;
  if (first_signal_ns.compare_exchange_strong(first, now) || now - first < kSimultaneousNs) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  first_signal_ns = 0;
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool InterruptGuard::requested() { return first_signal_ns != 0; }

}  // namespace broadmark
