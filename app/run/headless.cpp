// Output of a run besides its results: progress, tables, pictures, the original's logs.

#include "run/headless.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iostream>
#include <map>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/names.h"
#include "run/plan_run.h"
#include "run/recordings.h"
#include "run/wrong_pairs.h"
#include "support/exit_status.h"
#include "support/interrupt.h"
#include "support/output.h"
#include "support/progress.h"
#include "support/table.h"
#include "support/words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Reports a running plan on the terminal.
class HeadlessRun final : public TerminalTasks<RunObserver> {
 public:
  HeadlessRun(const RunRequest& request, bool quiet) : TerminalTasks(quiet), request_(request) {}

  void onRecordingResults(const PlanEntry& entry, std::span<const CaseResult> results) override {
    end();
    if (!prints_results_) std::cout << formatTable(results) << '\n' << std::flush;
    if (request_.print_pairs) printPairs(results);
    if (!entry.original) return;
    const fs::path log = entry.original->output_log;
    writeTextFile(log, formatOriginalLog(*entry.original, results.front()));
    written_.push_back(log);
  }
  void onRecordingEnd(const PlanEntry& entry, IndexedFrames& recording, Oracle& oracle) override {
    if (!entry.screenshot.empty()) draw(recording, oracle, entry.screenshot);
  }

  /// Prints the names of the written files. Returns the exit status. Throws Interrupted.
  int finish(const Results& results) {
    end();
    if (!request_.record.empty()) written_.push_back(request_.record);
    if (!results.cases.empty()) {
      for (const auto& [name, path] : request_.outputs) {
        if (!isStandardOutput(path)) written_.push_back(path);
      }
    }
    for (const fs::path& path : written_) {
      fmt::print(prints_results_ ? stderr : stdout, "written: {}\n", path.string());
    }
    if (!results.complete || InterruptGuard::requested()) {
      throw Interrupted(fmt::format("{} kept", counted(results.cases.size(), "finished case")));
    }
    std::vector<Status> statuses;
    for (const CaseResult& result : results.cases) statuses.push_back(result.status);
    if (request_.allow_timeout) std::erase(statuses, Status::timeout);
    const int status = exitStatusOf(statuses);
    return picture_failed_ && status != exit_status::wrong_answer ? exit_status::bad_input : status;
  }

 private:
  void printPairs(std::span<const CaseResult> results) {
    for (const CaseResult& result : results) {
      for (const FrameDifference& difference : result.differences) {
        if (!difference.isMismatch()) continue;
        fmt::print(
            prints_results_ ? stderr : stdout, "{}: {}frame {}: {}\n", result.id,
            difference.repetition == 0 ? "" : fmt::format("repetition {}, ", difference.repetition),
            difference.frame, wrongPairsText(difference));
      }
    }
    std::fflush(stdout);
  }

  void draw(IndexedFrames& recording, Oracle& oracle, const fs::path& path) {
    try {
      const SceneInfo& scene = recording.scene();
      const Frame frame = recording.at(request_.frame.value_or(scene.frames));
      const PairRun pairs = oracle.pairs(frame.boxes, frame.filterIn(scene), scene.periodic);
      const PictureOptions& picture = request_.picture;
      const auto context = makeOffscreenContext(picture.gl);
      writePng(path, drawFrame(*context, scene, frame, {&pairs, 1}, picture.width, picture.height));
      written_.push_back(path);
    } catch (const RenderError& error) {
      std::cerr << fmt::format("broadmark: no screenshot: {}\n", error.what());
      picture_failed_ = true;
    }
  }

  const RunRequest& request_;
  /// Whether results go to standard output, and therefore nothing else.
  const bool prints_results_ = useStandardOutput(request_.outputs);
  bool picture_failed_ = false;
  std::vector<fs::path> written_;
};

/// Throws InputError if an output file cannot be written, or would overwrite a source or another
/// output, to fail before a long run.
void requireWritable(const Plan& plan) {
  OutputFiles files;
  for (const PlanEntry& entry : plan.entries) {
    // The settings file, not the user, chooses this path.
    if (entry.original) requireBelow(fs::current_path(), entry.original->output_log);
    const Source& source = entry.source;
    files.addSource(source.simulation ? source.simulation->input()
                                      : fs::path(source.reference.path));
  }
  files.require(plan.request.outputs);
  for (const PlanEntry& entry : plan.entries) {
    if (!entry.screenshot.empty()) files.require("--screenshot", entry.screenshot);
    if (entry.original) files.require("m_outputLog", entry.original->output_log);
  }
}

}  // namespace

int runHeadless(Plan plan, bool quiet) {
  if (plan.entries.empty()) throw InputError("no cases left to run after --filter and --shard");
  requireSupportedIsa(plan);
  requireWritable(plan);
  if (!plan.request.record.empty()) makeDirectory(plan.request.record);
  for (const PlanEntry& entry : plan.entries) {
    if (!quiet) printImport(entry.source);
  }
  const InterruptGuard interrupts;
  HeadlessRun headless(plan.request, quiet);
  return headless.finish(runPlan(plan, executorFactory(plan.request.hosts), headless));
}

}  // namespace broadmark
