#include "inspector/jobs/background_reading.h"

#include <utility>

#include "sources/make_source.h"

namespace broadmark {

JobStatus ReadingReport::status() const {
  return {.activity = "A file is being read.", .values = {{"file", file.string()}}};
}

void startReading(BackgroundReading& job, std::filesystem::path file, FileImport import) {
  job.cancel();
  job.wait();
  ReadingReport initial;
  initial.file = file;
  job.start(std::move(initial), [&job, file = std::move(file), import = std::move(import)] {
    ReadingOptions options;
    options.progress = [&job](double fraction) {
      job.update([&](ReadingReport& report) { report.fraction = static_cast<float>(fraction); });
      return !job.cancelled();
    };
    auto source = std::make_shared<Source>(importedSource({file.string()}, import, options));
    job.update([&](ReadingReport& report) { report.source = std::move(source); });
    return true;
  });
}

}  // namespace broadmark
