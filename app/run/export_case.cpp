// Exports a failing case.

#include "run/export_case.h"

#include <fmt/format.h>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/fuzz/shrink.h"
#include "run/plan.h"
#include "run/recordings.h"
#include "run/wrong_pairs.h"
#include "support/interrupt.h"
#include "support/progress.h"
#include "support/words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Quotes a path as a shell word that is not parsed as an option.
std::string quotedPath(const fs::path& path) {
  const std::string text = path.string();
  return shellQuoted(text.starts_with('-') ? "./" + text : text);
}

/// Describes the shrunk case in one line.
std::string summaryOf(const ShrunkCase& shrunk, const SceneInfo& whole) {
  return fmt::format("{}: {} of {} ({}): {}", partName(whole),
                     extentText(shrunk.part.bodies.size(), shrunk.part.frames.size() - 1),
                     extentText(whole.objects, whole.frames), counted(shrunk.trials, "run"),
                     mismatchText(shrunk.difference));
}

}  // namespace

void requireExportable(const fs::path& file, const fs::path& original, const SceneInfo& scene) {
  requireRecordingName(file);
  requireHolds(file, scene);
  if (!original.empty() && fs::weakly_canonical(file) == fs::weakly_canonical(original)) {
    throw InputError(fmt::format("cannot export to {}: it is the recording itself", file.string()));
  }
  AtomicFile probe(file);
}

std::string reproducingCommand(const Case& test_case, const fs::path& recording) {
  std::string command = "broadmark --headless " + quotedPath(recording);
  const auto add = [&](std::string_view option, const std::string& word) {
    command += fmt::format(" {} {}", option, word);
  };
  const Algorithm& algorithm = test_case.algorithm;
  if (!algorithm.plugin.empty()) add("--plugin", quotedPath(algorithm.plugin));
  add("--algorithm", shellQuoted(algorithm.id));
  if (algorithm.traits.vectorised) add("--isa", std::string(isaName(test_case.isa)));
  if (algorithm.traits.parallel) add("--threads", fmt::format("{}", test_case.threads));
  if (!test_case.device.empty()) add("--device", shellQuoted(test_case.device));
  if (test_case.answer != AnswerKind::pairs) {
    add(isQuery(test_case.answer) ? "--queries" : "--answer", answerName(test_case.answer));
  }
  for (const auto& [key, value] : test_case.parameters)
    add("--param", shellQuoted(fmt::format("{}={}", key, value)));
  add("--check", "full");
  return command;
}

std::string tortureCommand(const Case& test_case, const fs::path& recording) {
  const std::string plugin =
      test_case.algorithm.plugin.empty() ? "" : test_case.algorithm.plugin + ":";
  return fmt::format("broadmark torture {} --only-sources --case {} --rounds 1 --output {}",
                     quotedPath(recording), shellQuoted(plugin + caseName(test_case)),
                     quotedPath(recording.parent_path() / "again"));
}

int runExportCase(Plan plan, const fs::path& file, bool quiet) {
  PlanEntry& entry = plan.entries.front();
  const auto difference = entry.knownDifference();
  if (!difference) {
    throw InputError(fmt::format("--export-case: case '{}' gave no wrong answer (status: {})",
                                 plan.request.case_id, statusName(entry.known->status)));
  }
  requireExportable(file, entry.source.reference.path, entry.source.reference.scene);
  const InterruptGuard interrupts;
  const auto recording = openForCommand(entry.source, quiet);

  const Case& test_case = entry.cases.front();
  const SceneInfo& whole = recording->scene();
  const std::uint64_t size = std::uint64_t{whole.objects} * difference->frame;
  Progress progress("shrinking " + whole.name, size, quiet);
  const ShrunkCase shrunk = shrinkCase(
      test_case, *recording, *difference,
      {.progress =
           [&](const ShrinkProgress& now) {
             progress.detail(extentText(now.bodies, now.frames));
             progress.update(size - std::min<std::uint64_t>(size, now.bodies * now.frames));
           },
       .cancelled = InterruptGuard::requested,
       .make_executor = executorFactory(plan.request.hosts)});
  if (shrunk.trials == 0) throw Interrupted();
  if (shrunk.minimal) progress.update(size);

  writeSelection(file, *recording, shrunk.part);
  progress.print(summaryOf(shrunk, whole));
  if (std::string boxes = smallPartText(*recording, shrunk.part); !boxes.empty()) {
    progress.print(boxes + "  " + wrongPairsText(shrunk.difference));
  }
  progress.print("written: " + file.string());
  progress.print(reproducingCommand(test_case, file));
  if (!shrunk.minimal) throw Interrupted("the smallest recording so far is written");
  return 0;
}

}  // namespace broadmark
