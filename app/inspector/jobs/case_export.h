// Exporting a failing case in the background: shrinks it to the smallest recording, and writes
// that.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "broadmark/frame.h"
#include "broadmark/fuzz/shrink.h"
#include "broadmark/harness/case_executor.h"
#include "broadmark/harness/oracle.h"
#include "inspector/jobs/job.h"

namespace broadmark {

struct ExportReport : TaskReport {
  static constexpr const char* kName = "exporting a case";
  static constexpr const char* kPrefix = "export";

  Case test_case;
  std::filesystem::path file;
  std::size_t whole_bodies = 0;
  std::size_t whole_frames = 0;  ///< up to the wrong one
  ShrinkProgress now;
  std::string command;  ///< once done: what shows the fault, for a shell

  [[nodiscard]] JobStatus status() const;
};

using CaseExport = Task<ExportReport>;

/// Starts an export: `test_case` answers wrongly on `source`, as `known` says. No other thread may
/// use `source`. Throws InputError while another export is running.
void startExport(CaseExport& job, const Case& test_case, std::unique_ptr<IndexedFrames> source,
                 FrameDifference known, std::filesystem::path file,
                 const ExecutorFactory& make_host = makeLocalHost);

}  // namespace broadmark
