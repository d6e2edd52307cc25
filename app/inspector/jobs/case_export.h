// Exports a failing case in the background: shrinks its recording, and writes the smallest one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
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
  std::size_t original_bodies = 0;
  std::size_t original_frames = 0;  ///< up to the wrong frame
  ShrinkProgress progress;
  std::string command;  ///< once done: shell command that reproduces the fault

  [[nodiscard]] JobStatus status() const;
};

using CaseExport = Task<ExportReport>;

/// Starts an export. `test_case` fails in the last frame of `source`, which no other thread may
/// use: `difference` is its wrong answer; nullopt: it ends with an error. Throws InputError while
/// another export is running.
void startExport(CaseExport& job, const Case& test_case, std::unique_ptr<IndexedFrames> source,
                 std::optional<FrameDifference> difference, std::filesystem::path file,
                 const ExecutorFactory& make_executor = makeInProcessExecutor);

}  // namespace broadmark
