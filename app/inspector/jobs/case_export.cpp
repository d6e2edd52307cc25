#include "inspector/jobs/case_export.h"

#include "broadmark/fuzz/shrink.h"
#include "run/export_case.h"

namespace broadmark {

void CaseExport::start(const Case& run, std::unique_ptr<IndexedFrames> source,
                       FrameDifference known, std::filesystem::path file,
                       const HostMaker& make_host) {
  Report first;
  first.run = run;
  first.file = std::move(file);
  first.whole_bodies = first.bodies = source->scene().objects;
  first.whole_frames = first.frames = known.frame;
  task_.begin(std::move(first), [this, source = std::move(source), known = std::move(known),
                                 make_host] { return shrinkAndWrite(*source, known, make_host); });
}

bool CaseExport::shrinkAndWrite(IndexedFrames& source, const FrameDifference& known,
                                const HostMaker& make_host) {
  const Report begun = report();
  const auto note = [this](const ShrinkProgress& now) {
    task_.update([&](Report& report) {
      report.trials = now.trials;
      report.bodies = now.bodies;
      report.frames = now.frames;
    });
  };
  const ShrunkCase shrunk = shrinkCase(begun.run, source, known,
                                       {.progress = note,
                                        .cancelled = [this] { return task_.cancelled(); },
                                        .make_host = make_host});
  if (!shrunk.minimal) return false;
  writePart(begun.file, source, shrunk.part);
  note({.trials = shrunk.trials,
        .bodies = shrunk.part.bodies.size(),
        .frames = shrunk.part.frames.size() - 1});
  task_.update([&](Report& report) { report.command = reproducingCommand(begun.run, begun.file); });
  return true;
}

}  // namespace broadmark
