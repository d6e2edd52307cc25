// Writes the report page of results in the background, by the Python package.
#pragma once

#include <filesystem>

#include "inspector/jobs/job.h"

namespace broadmark {

/// Returns the folder with this program's Python package, in its source tree or installation; "" if
/// there is none, or Python finds it by itself.
std::filesystem::path packageFolder(const std::filesystem::path& program);

struct PageReport : TaskReport {
  static constexpr const char* kName = "report page";
  static constexpr const char* kPrefix = "report";

  std::filesystem::path page;

  [[nodiscard]] JobStatus status() const;
};

using BackgroundReport = Task<PageReport>;

/// Starts to write the page. Throws InputError if it cannot, or while another page is written.
void startReport(BackgroundReport& job, const std::filesystem::path& results,
                 const std::filesystem::path& page);

}  // namespace broadmark
