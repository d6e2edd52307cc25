// Exporting a failing case in the background: shrinks it to the smallest recording, and writes
// that.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "broadmark/frame.h"
#include "broadmark/harness/case_host.h"
#include "broadmark/harness/oracle.h"
#include "inspector/jobs/background_task.h"

namespace broadmark {

class CaseExport {
 public:
  /// Sizes are those of the smallest part found so far.
  struct Report : TaskReport {
    Case run;
    std::filesystem::path file;
    std::size_t whole_bodies = 0;
    std::size_t whole_frames = 0;  ///< up to the wrong one
    std::uint64_t trials = 0;
    std::size_t bodies = 0;
    std::size_t frames = 0;
    std::string command;  ///< once done: what shows the fault, for a shell
  };

  /// Begins. `run` is wrong on `source`, used by nobody else, as `known` says. Throws InputError
  /// while another export is running.
  void start(const Case& run, std::unique_ptr<IndexedFrames> source, FrameDifference known,
             std::filesystem::path file, const HostMaker& make_host = makeLocalHost);
  /// Ends it soon; nothing is written then.
  void cancel() { task_.cancel(); }
  void wait() { task_.wait(); }
  [[nodiscard]] bool running() const { return task_.running(); }
  [[nodiscard]] Report report() const { return task_.report(); }
  /// Whether it has ended since this was last asked.
  bool takeEnd() { return task_.takeEnd(); }

 private:
  /// Returns whether it was written: not when cancelled.
  bool shrinkAndWrite(IndexedFrames& source, const FrameDifference& known,
                      const HostMaker& make_host);

  BackgroundTask<Report> task_{"exporting a case"};
};

}  // namespace broadmark
