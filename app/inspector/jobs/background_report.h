// The report page of results, written in the background by the Python package.
#pragma once

#include <filesystem>
#include <string>

#include "inspector/jobs/background_task.h"

namespace broadmark {

/// Where Python is to look for the package of this program: beside the source it was built from,
/// or where it is installed; "": Python knows by itself, or it is not there.
std::filesystem::path packageFolder(const std::filesystem::path& program);

/// Writes one page at a time.
class BackgroundReport {
 public:
  struct Report : TaskReport {
    std::filesystem::path page;
  };

  /// Begins. Throws InputError where nothing can be written, and while another one is written.
  void start(const std::filesystem::path& results, const std::filesystem::path& page);
  void cancel() { task_.cancel(); }
  void wait() { task_.wait(); }
  [[nodiscard]] bool running() const { return task_.running(); }
  [[nodiscard]] Report report() const { return task_.report(); }
  /// Whether one has ended since this was last asked.
  bool takeEnd() { return task_.takeEnd(); }

 private:
  BackgroundTask<Report> task_{"report page"};
};

}  // namespace broadmark
