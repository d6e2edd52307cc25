// The report page of results, written in the background by the Python package.
#pragma once

#include <filesystem>

#include "inspector/jobs/job.h"

namespace broadmark {

/// Where Python is to look for the package of this program: beside the source it was built from,
/// or where it is installed; "": Python knows by itself, or it is not there.
std::filesystem::path packageFolder(const std::filesystem::path& program);

struct PageReport : TaskReport {
  static constexpr const char* kName = "report page";
  static constexpr const char* kPrefix = "report";

  std::filesystem::path page;

  [[nodiscard]] JobStatus status() const;
};

using BackgroundReport = Task<PageReport>;

/// Begins. Throws InputError where nothing can be written, and while another one is written.
void startReport(BackgroundReport& job, const std::filesystem::path& results,
                 const std::filesystem::path& page);

}  // namespace broadmark
