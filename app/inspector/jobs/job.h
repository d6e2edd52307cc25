// Background work: the common interface, and the thread that runs it.
#pragma once

#include <atomic>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/names.h"
#include "support/granted_thread.h"

namespace broadmark {

enum class TaskState { idle, running, done, cancelled, failed };
inline constexpr NameTable kTaskStates{{NamedValue{TaskState::idle, "idle"},
                                        {TaskState::running, "running"},
                                        {TaskState::done, "done"},
                                        {TaskState::cancelled, "cancelled"},
                                        {TaskState::failed, "failed"}}};

/// Base of all reports.
struct TaskReport {
  TaskState state = TaskState::idle;
  std::string failure = {};  ///< error text, if failed
  // Progress, if the work measures it:
  float fraction = 0;         ///< completed fraction
  double seconds_left = 0;    ///< 0: unknown
  std::string activity = {};  ///< description of the current step
};

/// State by name, as text.
using Values = std::map<std::string, std::string>;

/// The state of a job of any kind.
struct JobStatus {
  std::string activity;             ///< sentence for a running job
  std::string outcome = {};         ///< status bar text of a finished job; "": none
  bool is_error = false;            ///< the outcome is an error
  std::filesystem::path file = {};  ///< written by a finished job, for the recent files; "": none
  Values values = {};               ///< for scripts and tests
  std::string failure = {};         ///< error text, if failed
};

/// Background work of one kind; one task runs at a time.
class Job {
 public:
  explicit Job(std::string prefix) : value_prefix(std::move(prefix)) {}
  virtual ~Job() = default;
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  [[nodiscard]] virtual JobStatus status() const = 0;
  [[nodiscard]] virtual bool running() const = 0;
  /// Requests cancellation; finished parts are kept.
  virtual void cancel() = 0;
  /// Returns whether the work has finished since the last call.
  virtual bool consumeFinished() = 0;

  const std::string value_prefix;  ///< prefix of the value names: "batch"
};

/// A job that reports its progress. `Report` is derived from TaskReport and defines kName (the
/// work's name in messages: "baking"), kPrefix, and `JobStatus status() const` without the failure
/// and without the value "state".
template <class R>
class Task final : public Job {
 public:
  using Report = R;

  Task() : Job(Report::kPrefix) {}
  /// Cancels the work, and joins the thread.
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
  bool consumeFinished() override { return finished_.exchange(false); }
  /// Waits until the work has finished.
  void wait() {
    if (thread_.joinable()) thread_.join();
  }

  /// Starts `work()` with the report `initial`. `work` polls cancelled(), and returns whether it
  /// completed; its exceptions become the failure. Returns only when it has ended if the system
  /// grants no thread. Throws InputError while earlier work is running.
  template <class Work>
  void start(Report initial, Work work) {
    if (running()) {
      throw InputError(std::string(Report::kName) +
                       ": still running: wait until it finishes, or cancel it");
    }
    wait();
    cancelled_ = false;
    finished_ = false;
    initial.state = TaskState::running;
    update([&](Report& report) { report = std::move(initial); });
    const auto shared_work = std::make_shared<Work>(std::move(work));
    thread_ = grantedThread([this, shared_work] { perform(*shared_work); });
    if (!thread_.joinable()) perform(*shared_work);
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
      finished_ = true;
    });
  }

  std::atomic<bool> cancelled_ = false;
  std::atomic<bool> finished_ = false;
  mutable std::mutex mutex_;
  Report report_;  ///< guarded by mutex_
  std::thread thread_;
};

}  // namespace broadmark
