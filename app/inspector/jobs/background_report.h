// The report page of results, written in the background by the Python package.
#pragma once

#include <filesystem>
#include <string>

#include "inspector/jobs/job.h"

namespace broadmark {

/// Where Python is to look for the package of this program: beside the source it was built from,
/// or where it is installed; "": Python knows by itself, or it is not there.
std::filesystem::path packageFolder(const std::filesystem::path& program);

struct PageReport : TaskReport {
  std::filesystem::path page;
};

/// Writes one page at a time.
class BackgroundReport final : public ReportingJob<PageReport> {
 public:
  BackgroundReport() : ReportingJob("report page", "report") {}
  ~BackgroundReport() override { finish(); }

  /// Begins. Throws InputError where nothing can be written, and while another one is written.
  void start(const std::filesystem::path& results, const std::filesystem::path& page);

 private:
  [[nodiscard]] JobStatus statusOf(const Report& report) const override;
};

}  // namespace broadmark
