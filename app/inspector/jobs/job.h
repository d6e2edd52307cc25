// Work in the background: what all its kinds have in common, and the thread it runs on.
#pragma once

#include <atomic>
#include <exception>
#include <map>
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
  // Of work that knows how far it is:
  float fraction = 0;       ///< of the work
  double seconds_left = 0;  ///< 0: not known
  std::string doing = {};   ///< at present, in words
};

/// State as text, by name.
using Values = std::map<std::string, std::string>;

/// What every kind of job states about itself.
struct JobStatus {
  std::string doing;         ///< while it is running, as a sentence
  std::string outcome = {};  ///< once it has ended, for the status bar; "": nothing
  bool faulty = false;       ///< the outcome is an error
  Values values = {};        ///< for scripts and tests
  std::string failure = {};  ///< of a failed one
};

/// Work in the background, one piece at a time.
class Job {
 public:
  explicit Job(std::string prefix) : value_prefix(std::move(prefix)) {}
  virtual ~Job() = default;
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  [[nodiscard]] virtual JobStatus status() const = 0;
  [[nodiscard]] virtual bool running() const = 0;
  /// Ends the work soon; what is finished is kept.
  virtual void cancel() = 0;
  /// Whether it has ended since this was last asked.
  virtual bool takeEnd() = 0;

  const std::string value_prefix;  ///< of its values' names: "batch"
};

/// A job that reports its progress. `Report` is derived from TaskReport and states kName, which
/// stands for the work in messages ("baking"), kPrefix and
/// `JobStatus status() const`: all but the failure; of the values not the state.
template <class R>
class Task final : public Job {
 public:
  using Report = R;

  Task() : Job(Report::kPrefix) {}
  /// Cancels the work, and waits for its end.
  ~Task() override {
    cancel();
    wait();
  }

  void cancel() override { cancelled_ = true; }
  [[nodiscard]] bool cancelled() const { return cancelled_; }
  [[nodiscard]] bool running() const override {
    const std::lock_guard lock(mutex_);
    return report_.state == TaskState::running;
  }
  [[nodiscard]] Report report() const {
    const std::lock_guard lock(mutex_);
    return report_;
  }
  [[nodiscard]] JobStatus status() const override {
    const Report now = report();
    JobStatus status = now.status();
    status.failure = now.failure;
    status.values["state"] = kTaskStates.nameOf(now.state);
    return status;
  }
  bool takeEnd() override { return ended_.exchange(false); }
  /// Returns when the work has ended.
  void wait() {
    if (thread_.joinable()) thread_.join();
  }

  /// Begins with the report `first`. `work()` asks cancelled() now and then, and returns whether it
  /// was completed; what it throws becomes the failure. Throws InputError while earlier work is
  /// running.
  template <class Work>
  void begin(Report first, Work work) {
    if (running()) {
      throw InputError(std::string(Report::kName) +
                       ": still running: wait for its end, or cancel it");
    }
    wait();
    cancelled_ = false;
    ended_ = false;
    first.state = TaskState::running;
    update([&](Report& report) { report = std::move(first); });
    thread_ = std::thread([this, work = std::move(work)]() mutable { perform(work); });
  }
  /// Changes the report under its lock.
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
      failure = std::string(Report::kName) + ": out of memory";
    } catch (const std::exception& error) {
      failure = error.what();
    }
    update([&](Report& report) {
      report.state = end;
      report.failure = std::move(failure);
      ended_ = true;
    });
  }

  std::atomic<bool> cancelled_ = false;
  std::atomic<bool> ended_ = false;
  mutable std::mutex mutex_;
  Report report_;  ///< guarded by mutex_
  std::thread thread_;
};

}  // namespace broadmark
