// Reads files of other programs in the background.
#pragma once

#include <filesystem>
#include <memory>

#include "inspector/jobs/job.h"
#include "sources/source.h"

namespace broadmark {

struct ReadingReport : TaskReport {
  static constexpr const char* kName = "reading a file";
  static constexpr const char* kPrefix = "reading";

  std::filesystem::path file;
  std::shared_ptr<Source> source;  ///< once done

  [[nodiscard]] JobStatus status() const;
};

using BackgroundReading = Task<ReadingReport>;

/// Starts to read a file for which importOf() knows how. Earlier reading is cancelled.
void startReading(BackgroundReading& job, std::filesystem::path file, FileImport import);

}  // namespace broadmark
