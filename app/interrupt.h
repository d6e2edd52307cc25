// Ctrl-C and termination: the first signal asks for a clean end, the second ends at once.
#pragma once

namespace broadmark {

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
