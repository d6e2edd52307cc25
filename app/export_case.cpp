// broadmark --headless results.json --case ID --export-case FILE: the smallest recording on which
// the case still fails, and the command that shows it.

#include <fmt/format.h>

#include "case_reference.h"
#include "interrupt.h"
#include "options.h"
#include "plugins.h"
#include "progress.h"
#include "words.h"
#include "broadmark/error.h"
#include "broadmark/shrink.h"

namespace broadmark {
namespace {

/// What is left, in one line.
std::string summaryOf(const ShrunkCase& shrunk, const SceneInfo& whole) {
  const FrameDifference& difference = shrunk.difference;
  return fmt::format("{}: {} of {} ({} runs): {} missed, {} false, {} invalid", partName(whole),
                     extentText(shrunk.selection.bodies.size(), shrunk.selection.frames.size() - 1),
                     extentText(whole.objects, whole.frames), shrunk.trials,
                     difference.missed_count, difference.forbidden_count, difference.invalid_count);
}

}  // namespace

int runExportCase(const HeadlessOptions& options) {
  CaseReference reference =
      openCase(options.sources.front(), options.case_id, availableAlgorithms(options.plugins));
  if (!reference.difference) {
    throw InputError(fmt::format("--export-case: case '{}' gave no wrong answer (status: {})",
                                 options.case_id, statusName(reference.result.status)));
  }
  requireExportable(options.export_case, reference.source.reference.path);
  const InterruptGuard guard;
  const auto recording = openRecording(reference.source, {}, {}, options.quiet);
  if (!recording) throw InputError("interrupted");

  const SceneInfo& whole = recording->scene();
  const std::uint64_t size = std::uint64_t{whole.objects} * reference.difference->frame;
  Progress progress("shrinking " + whole.name, size, options.quiet);
  const ShrunkCase shrunk = shrinkCase(
      reference.run, *recording, *reference.difference,
      {.progress =
           [&](const ShrinkProgress& now) {
             progress.detail(extentText(now.bodies, now.frames));
             progress.update(size - std::min<std::uint64_t>(size, now.bodies * now.frames));
           },
       .cancelled = InterruptGuard::requested});
  if (shrunk.trials == 0) throw InputError("interrupted");
  if (shrunk.minimal) progress.update(size);

  writePart(options.export_case, *recording, shrunk.selection);
  progress.print(summaryOf(shrunk, whole));
  progress.print("written: " + options.export_case.string());
  progress.print(reproducingCommand(reference.run, options.export_case));
  if (!shrunk.minimal) throw InputError("interrupted: the smallest part so far is written");
  return 0;
}

}  // namespace broadmark
