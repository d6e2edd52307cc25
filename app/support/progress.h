// Progress of long work, with an estimate of the time left.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "support/interrupt.h"

namespace broadmark {

/// Receives the progress of long work, and may cancel it.
class TaskObserver {
 public:
  virtual ~TaskObserver() = default;

  /// Called between steps; returning true ends the work.
  virtual bool cancelled() = 0;
  /// Called when a task with this number of steps starts; the previous task has ended.
  virtual void onTaskStart(const std::string& task, std::uint64_t steps) = 0;
  /// Called when `done` steps of the task are done; `detail` names the current one.
  virtual void onProgress(std::uint64_t done, const std::string& detail = {}) = 0;
  /// Called with a line for the user about the current task.
  virtual void onNote(const std::string& /*line*/) {}
};

/// Shows the progress of a task on standard error: on a terminal as a single line, truncated to the
/// terminal's width; else as a line every 15 seconds, and one when the task ends. Shows nothing if
/// `quiet`.
class Progress {
 public:
  Progress(std::string task, std::uint64_t steps, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Sets the name of the current step.
  void detail(std::string text) { detail_ = std::move(text); }
  /// Sets the number of finished steps, and extrapolates the time left.
  void update(std::uint64_t done);
  /// Same with a better estimate of the time left.
  void update(std::uint64_t done, double seconds_left);
  /// Like update(), for interruptible work: returns false once the user has interrupted it.
  bool advance(std::uint64_t done) {
    update(done);
    return !InterruptGuard::requested();
  }

  /// Whether it is time to draw again: only then update() shows anything.
  [[nodiscard]] bool isDue() const;

  /// Prints a line on standard output or error without disturbing the progress line.
  void print(std::string_view line) { print(stdout, line); }
  void printError(std::string_view line) { print(stderr, line); }

 private:
  using Clock = std::chrono::steady_clock;
  void print(std::FILE* stream, std::string_view line);
  void draw(double seconds_left);

  std::string task_;
  std::string detail_;
  std::uint64_t steps_;
  std::uint64_t done_ = 0;
  bool quiet_;
  bool terminal_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_ = start_;
};

/// Shows successive tasks as Progress; Ctrl-C (InterruptGuard) ends them.
template <class Observer = TaskObserver>
class TerminalTasks : public Observer {
 public:
  explicit TerminalTasks(bool quiet) : quiet_(quiet) {}

  bool cancelled() override { return InterruptGuard::requested(); }
  void onTaskStart(const std::string& task, std::uint64_t steps) override {
    end();  // prints the previous task's last line before this one's first
    progress_.emplace(task, steps, quiet_);
  }
  void onProgress(std::uint64_t done, const std::string& detail = {}) override {
    progress_->detail(detail);
    progress_->update(done);
  }
  void onNote(const std::string& line) override { progress_->printError(line); }
  /// Ends the current task.
  void end() { progress_.reset(); }

 private:
  bool quiet_;
  std::optional<Progress> progress_;
};

}  // namespace broadmark
