// Ctrl-C and termination: the first signal requests a clean shutdown, the second exits immediately.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace broadmark {

/// Thrown when the user interrupts a command; not an error. The message states what was saved.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
  explicit Interrupted(const std::string& saved)
      : std::runtime_error(fmt::format("interrupted: {}", saved)) {}
};

/// Handles SIGINT and SIGTERM during its lifetime. Only one instance may exist at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether a clean shutdown has been requested. Thread-safe.
  [[nodiscard]] static bool requested();
};

}  // namespace broadmark
