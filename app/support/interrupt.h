// Ctrl-C and termination: the first signal asks for a clean end, the second ends at once.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace broadmark {

/// Thrown out of a command that the user has ended: no fault of anybody's. The message says what is
/// kept.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
  explicit Interrupted(const std::string& kept)
      : std::runtime_error(fmt::format("interrupted: {}", kept)) {}
};

/// Handles SIGINT and SIGTERM while it lives. At most one lives at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether a clean end has been asked for. Any thread may call it.
  [[nodiscard]] static bool requested();
};

}  // namespace broadmark
