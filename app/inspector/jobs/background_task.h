// Work on a thread of its own, and the report of how far it is.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/names.h"

namespace broadmark {

enum class TaskState { idle, running, done, cancelled, failed };
inline constexpr NameTable kTaskStates{{NamedValue{TaskState::idle, "idle"},
                                        {TaskState::running, "running"},
                                        {TaskState::done, "done"},
                                        {TaskState::cancelled, "cancelled"},
                                        {TaskState::failed, "failed"}}};

/// Part of every report.
struct TaskReport {
  TaskState state = TaskState::idle;
  std::string failure = {};  ///< of a failed one
};

/// Of work that knows how far it is.
struct WorkReport : TaskReport {
  float fraction = 0;       ///< of the work
  double seconds_left = 0;  ///< 0: not known
  std::string doing = {};   ///< at present, in words
};

/// One piece of work at a time. `Report` is derived from TaskReport.
template <class Report>
class BackgroundTask {
 public:
  /// `name` stands for the work in messages: "baking".
  explicit BackgroundTask(std::string name) : name_(std::move(name)) {}
  /// Cancels what is running, and waits for it.
  ~BackgroundTask() {
    cancel();
    wait();
  }
  BackgroundTask(const BackgroundTask&) = delete;
  BackgroundTask& operator=(const BackgroundTask&) = delete;

  /// Begins with the report `first`. `work()` asks cancelled() now and then, and returns whether it
  /// went through to the end; what it throws becomes the failure. Throws InputError while the work
  /// before is still running.
  template <class Work>
  void begin(Report first, Work work) {
    if (running()) throw InputError(name_ + ": still running: wait for its end, or cancel it");
    wait();
    cancelled_ = false;
    ended_ = false;
    first.state = TaskState::running;
    update([&](Report& report) { report = std::move(first); });
    thread_ = std::thread([this, work = std::move(work)]() mutable { perform(work); });
  }
  /// Ends it soon.
  void cancel() { cancelled_ = true; }
  /// Returns when it has ended.
  void wait() {
    if (thread_.joinable()) thread_.join();
  }
  [[nodiscard]] bool cancelled() const { return cancelled_; }

  [[nodiscard]] Report report() const {
    const std::lock_guard lock(mutex_);
    return report_;
  }
  [[nodiscard]] bool running() const {
    const std::lock_guard lock(mutex_);
    return report_.state == TaskState::running;
  }
  /// Whether it has ended since this was last asked.
  bool takeEnd() { return ended_.exchange(false); }

  /// Changes the report while nobody reads it.
  template <class Change>
  void update(Change&& change) {
    const std::lock_guard lock(mutex_);
    change(report_);
  }

 private:
  template <class Work>
  void perform(Work& work) {
    TaskState end = TaskState::failed;
    std::string failure;
    try {
      end = work() ? TaskState::done : TaskState::cancelled;
    } catch (const Cancelled&) {
      end = TaskState::cancelled;
    } catch (const std::bad_alloc&) {
      failure = name_ + ": out of memory";
    } catch (const std::exception& error) {
      failure = error.what();
    }
    update([&](Report& report) {
      report.state = end;
      report.failure = std::move(failure);
      ended_ = true;
    });
  }

  std::string name_;
  std::atomic<bool> cancelled_ = false;
  std::atomic<bool> ended_ = false;
  mutable std::mutex mutex_;
  Report report_;  ///< guarded by mutex_
  std::thread thread_;
};

}  // namespace broadmark
