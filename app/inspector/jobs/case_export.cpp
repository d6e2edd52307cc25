#include "inspector/jobs/case_export.h"

#include "broadmark/fuzz/shrink.h"
#include "run/export_case.h"

namespace broadmark {

JobStatus CaseExport::statusOf(const Report& report) const {
  const bool done = report.state == TaskState::done;
  return {.doing = "A case is being exported.",
          .outcome = done ? "exported: " + report.file.string() : "",
          .values = {{"trials", std::to_string(report.trials)},
                     {"bodies", std::to_string(report.bodies)},
                     {"frames", std::to_string(report.frames)},
                     {"file", report.file.string()},
                     {"command", report.command}}};
}

void CaseExport::start(const Case& run, std::unique_ptr<IndexedFrames> source,
                       FrameDifference known, std::filesystem::path file,
                       const HostMaker& make_host) {
  Report first;
  first.run = run;
  first.file = std::move(file);
  first.whole_bodies = first.bodies = source->scene().objects;
  first.whole_frames = first.frames = known.frame;
  begin(std::move(first), [this, source = std::move(source), known = std::move(known), make_host] {
    return shrinkAndWrite(*source, known, make_host);
  });
}

bool CaseExport::shrinkAndWrite(IndexedFrames& source, const FrameDifference& known,
                                const HostMaker& make_host) {
  const Report begun = report();
  const auto note = [this](const ShrinkProgress& now) {
    update([&](Report& report) {
      report.trials = now.trials;
      report.bodies = now.bodies;
      report.frames = now.frames;
    });
  };
  const ShrunkCase shrunk = shrinkCase(
      begun.run, source, known,
      {.progress = note, .cancelled = [this] { return cancelled(); }, .make_host = make_host});
  if (!shrunk.minimal) return false;
  writePart(begun.file, source, shrunk.part);
  note({.trials = shrunk.trials,
        .bodies = shrunk.part.bodies.size(),
        .frames = shrunk.part.frames.size() - 1});
  update([&](Report& report) { report.command = reproducingCommand(begun.run, begun.file); });
  return true;
}

}  // namespace broadmark
