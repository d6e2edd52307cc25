#include "inspector/jobs/case_export.h"

#include "run/export_case.h"

namespace broadmark {

namespace {

/// Returns whether it was written: not when cancelled.
bool shrinkAndWrite(CaseExport& job, IndexedFrames& source, const FrameDifference& known,
                    const ExecutorFactory& make_host) {
  const ExportReport begun = job.report();
  const auto note = [&job](const ShrinkProgress& now) {
    job.update([&](ExportReport& report) { report.now = now; });
  };
  const ShrunkCase shrunk = shrinkCase(
      begun.test_case, source, known,
      {.progress = note, .cancelled = [&job] { return job.cancelled(); }, .make_host = make_host});
  if (!shrunk.minimal) return false;
  writePart(begun.file, source, shrunk.part);
  note({.trials = shrunk.trials,
        .bodies = shrunk.part.bodies.size(),
        .frames = shrunk.part.frames.size() - 1});
  job.update([&](ExportReport& report) {
    report.command = reproducingCommand(begun.test_case, begun.file);
  });
  return true;
}

}  // namespace

JobStatus ExportReport::status() const {
  return {.doing = "A case is being exported.",
          .outcome = state == TaskState::done ? "exported: " + file.string() : "",
          .values = {{"trials", std::to_string(now.trials)},
                     {"bodies", std::to_string(now.bodies)},
                     {"frames", std::to_string(now.frames)},
                     {"file", file.string()},
                     {"command", command}}};
}

void startExport(CaseExport& job, const Case& test_case, std::unique_ptr<IndexedFrames> source,
                 FrameDifference known, std::filesystem::path file,
                 const ExecutorFactory& make_host) {
  ExportReport first;
  first.test_case = test_case;
  first.file = std::move(file);
  first.whole_bodies = first.now.bodies = source->scene().objects;
  first.whole_frames = first.now.frames = known.frame;
  job.begin(std::move(first),
            [&job, source = std::move(source), known = std::move(known), make_host] {
              return shrinkAndWrite(job, *source, known, make_host);
            });
}

}  // namespace broadmark
