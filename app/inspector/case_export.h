// Exporting a failing case while the window lives on: shrinks it to the smallest recording on a
// thread of its own, and writes that.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "broadmark/runner.h"
#include "broadmark/shrink.h"

namespace broadmark {

class CaseExport {
 public:
  enum class State { idle, running, done, cancelled, failed };

  /// How it stands. Sizes are those of the smallest part found so far.
  struct Report {
    State state = State::idle;
    Case run;
    std::filesystem::path file;
    std::size_t whole_bodies = 0;
    std::size_t whole_frames = 0;  ///< up to the wrong one
    std::uint64_t trials = 0;
    std::size_t bodies = 0;
    std::size_t frames = 0;
    std::string command;  ///< once done: what shows the fault, for a shell
    std::string failure;  ///< of a failed one
  };

  CaseExport() = default;
  /// Cancels what is running, and waits for it.
  ~CaseExport();
  CaseExport(const CaseExport&) = delete;
  CaseExport& operator=(const CaseExport&) = delete;

  /// Begins. `run` is wrong on `source`, used by nobody else, as `known` says. Throws InputError
  /// when one is running already.
  void start(const Case& run, std::unique_ptr<FrameSource> source, FrameDifference known,
             std::filesystem::path file);
  /// Ends it soon; nothing is written then.
  void cancel() { cancelled_ = true; }
  [[nodiscard]] bool running() const { return report().state == State::running; }
  [[nodiscard]] Report report() const;
  /// Whether it has ended since this was last asked.
  bool takeEnd() { return ended_.exchange(false); }

 private:
  void work(FrameSource& source, const FrameDifference& known);
  /// Shrinks and writes; returns how it ended.
  State shrinkAndWrite(FrameSource& source, const FrameDifference& known);

  std::atomic<bool> cancelled_ = false;
  std::atomic<bool> ended_ = false;
  mutable std::mutex mutex_;
  Report report_;  ///< guarded by mutex_
  std::thread thread_;
};

/// The state in a word: "running".
const char* exportStateName(CaseExport::State state);

}  // namespace broadmark
