#include "inspector/jobs/case_export.h"

#include "run/export_case.h"

namespace broadmark {

namespace {

/// Returns false if cancelled.
bool shrinkAndWrite(CaseExport& job, IndexedFrames& source,
                    const std::optional<FrameDifference>& difference,
                    const ExecutorFactory& make_executor) {
  const ExportReport initial = job.report();
  const auto on_progress = [&job](const ShrinkProgress& progress) {
    job.update([&](ExportReport& report) { report.progress = progress; });
  };
  const ShrinkOptions options{.progress = on_progress,
                              .cancelled = [&job] { return job.cancelled(); },
                              .make_executor = make_executor};
  const ShrunkPart shrunk =
      difference ? shrinkCase(initial.test_case, source, *difference, options)
                 : shrinkFailure(initial.test_case, source, source.scene().frames, options);
  if (!shrunk.minimal) return false;
  writeSelection(initial.file, source, shrunk.part);
  on_progress({.trials = shrunk.trials,
               .bodies = shrunk.part.bodies.size(),
               .frames = shrunk.part.frames.size() - 1});
  job.update([&](ExportReport& report) {
    report.command = reproducingCommand(initial.test_case, initial.file);
  });
  return true;
}

}  // namespace

JobStatus ExportReport::status() const {
  return {.activity = "A case is being exported.",
          .outcome = state == TaskState::done ? "exported: " + file.string() : "",
          .values = {{"trials", std::to_string(progress.trials)},
                     {"bodies", std::to_string(progress.bodies)},
                     {"frames", std::to_string(progress.frames)},
                     {"file", file.string()},
                     {"command", command}}};
}

void startExport(CaseExport& job, const Case& test_case, std::unique_ptr<IndexedFrames> source,
                 std::optional<FrameDifference> difference, std::filesystem::path file,
                 const ExecutorFactory& make_executor) {
  ExportReport initial;
  initial.test_case = test_case;
  initial.file = std::move(file);
  initial.original_bodies = initial.progress.bodies = source->scene().objects;
  initial.original_frames = initial.progress.frames = source->scene().frames;
  job.start(std::move(initial),
            [&job, source = std::move(source), difference = std::move(difference), make_executor] {
              return shrinkAndWrite(job, *source, difference, make_executor);
            });
}

}  // namespace broadmark
