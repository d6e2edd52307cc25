// A signal handler reports crashes; a thread watches the time of calls. Either ends the process
// without cleaning up, as the plug-in may hold any lock.

#include "request/plugin_guard.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstring>
#include <map>
#include <mutex>
#include <thread>

#include "broadmark/scenes/engine_observer.h"
#include "support/exit_status.h"
#include "support/interrupt.h"

namespace broadmark {
namespace {

using Clock = std::chrono::steady_clock;

/// Message of a crash in the current call of this thread, without its end; "": no call.
thread_local char crash_message[512];

void print(const char* text) {
  // Nothing is left to do if this fails.
  static_cast<void>(!::write(STDERR_FILENO, text, std::strlen(text)));
}

[[noreturn]] void end(const std::string& message, int status) {
  print(fmt::format("broadmark: {}\n", message).c_str());
  std::_Exit(status);
}

const char* nameOf(int signal) {
  switch (signal) {
    case SIGSEGV:
      return "segmentation fault\n";
    case SIGBUS:
      return "bus error\n";
    case SIGFPE:
      return "arithmetic error\n";
    case SIGILL:
      return "illegal instruction\n";
    default:
      return "aborted\n";
  }
}

/// The default action applies after it returns.
void onCrash(int signal) {
  if (crash_message[0] == '\0') return;
  print(crash_message);
  print(nameOf(signal));
  std::_Exit(exit_status::bad_input);
}

/// Watches the time of calls.
class Watchdog {
 public:
  void setLimit(double seconds) {
    const std::lock_guard lock(mutex_);
    limit_seconds_ = seconds;
  }

  void start(const std::string& what) {
    const std::lock_guard lock(mutex_);
    if (!thread_.joinable()) thread_ = std::thread([this] { watch(); });
    calls_[std::this_thread::get_id()] = {what, Clock::now()};
    changed_.notify_all();
  }

  void end() {
    const std::lock_guard lock(mutex_);
    calls_.erase(std::this_thread::get_id());
  }

 private:
  struct Call {
    std::string what;
    Clock::time_point start;
  };

  void watch() {
    constexpr std::chrono::milliseconds kInterval{100};
    constexpr double kInterruptedSeconds = 1;
    std::unique_lock lock(mutex_);
    Clock::time_point interrupted{};
    while (true) {
      changed_.wait(lock, [this] { return !calls_.empty(); });
      const Clock::time_point now = Clock::now();
      const bool is_interrupted = InterruptGuard::requested();
      if (!is_interrupted) interrupted = now;
      for (const auto& [thread, call] : calls_) {
        const auto since = [&](Clock::time_point time) {
          return std::chrono::duration<double>(now - std::max(time, call.start)).count();
        };
        if (is_interrupted && since(interrupted) > kInterruptedSeconds) {
          broadmark::end(fmt::format("interrupted: {}: had not returned", call.what),
                         exit_status::interrupted);
        }
        if (since(call.start) > limit_seconds_) {
          broadmark::end(
              fmt::format("{}: no answer within {} s (--hard-limit)", call.what, limit_seconds_),
              exit_status::bad_input);
        }
      }
      lock.unlock();
      std::this_thread::sleep_for(kInterval);
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  double limit_seconds_ = kNoEngineLimit;
  std::map<std::thread::id, Call> calls_;
  std::thread thread_;
};

void handleCrashes() {
  struct sigaction action = {};
  action.sa_handler = onCrash;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    ::sigaction(signal, &action, nullptr);
  }
}

class Guard final : public scenes::EngineObserver {
 public:
  Guard() { scenes::observeEngines(*this); }

  void onCallStart(const std::string& what) override {
    // Libraries that were loaded since the last call may have replaced the handlers, as LLVM in
    // OpenCL drivers does.
    handleCrashes();
    const std::string message = fmt::format("broadmark: {}: crashed: ", what);
    crash_message[message.copy(crash_message, sizeof(crash_message) - 1)] = '\0';
    watchdog.start(what);
  }
  void onCallEnd() override {
    crash_message[0] = '\0';
    watchdog.end();
  }

  Watchdog watchdog;
};

Guard* guard = nullptr;

}  // namespace

void guardEngines(double limit_seconds) {
  // Never destroyed: its thread runs until the process ends.
  if (guard == nullptr) guard = new Guard;
  guard->watchdog.setLimit(limit_seconds);
}

PluginCall::PluginCall(const std::string& what) {
  if (guard != nullptr) guard->onCallStart(what);
}

PluginCall::~PluginCall() {
  if (guard != nullptr) guard->onCallEnd();
}

}  // namespace broadmark
