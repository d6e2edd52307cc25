// What a run tells and writes beside its results: progress, tables, pictures, the original's logs.

#include "run/headless.h"

#include <fmt/format.h>

#include <iostream>
#include <map>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "run/plan_run.h"
#include "run/recordings.h"
#include "support/exit_status.h"
#include "support/interrupt.h"
#include "support/output.h"
#include "support/progress.h"
#include "support/table.h"
#include "support/words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Reports a plan on the terminal while it is run.
class HeadlessRun final : public TerminalTasks<RunObserver> {
 public:
  HeadlessRun(const RunRequest& request, bool quiet) : TerminalTasks(quiet), request_(request) {}

  void onRecordingResults(const PlanEntry& entry, std::span<const CaseResult> results) override {
    end();
    if (!prints_results_) std::cout << formatTable(results) << std::endl;
    if (!entry.original) return;
    const fs::path log = entry.original->output_log;
    writeTextFile(log, formatOriginalLog(*entry.original, results.front()));
    written_.push_back(log);
  }
  void onRecordingEnd(const PlanEntry& entry, IndexedFrames& recording, Oracle& oracle) override {
    if (!entry.screenshot.empty()) draw(recording, oracle, entry.screenshot);
  }

  /// Prints the results that go to standard output, and says what has been written. Returns the
  /// exit status. Throws Interrupted.
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
    std::vector<Status> judged;
    for (const CaseResult& result : results.cases) judged.push_back(result.status);
    if (request_.allow_timeout) std::erase(judged, Status::timeout);
    const int status = exitStatusOf(judged);
    return picture_failed_ && status != exit_status::wrong_answer ? exit_status::bad_input : status;
  }

 private:
  void draw(IndexedFrames& recording, Oracle& oracle, const fs::path& path) {
    try {
      const SceneInfo& scene = recording.scene();
      const Frame frame = recording.at(request_.frame.value_or(scene.frames));
      const PairRun pairs = oracle.pairs(frame.boxes, scene.filter);
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
  /// Results go to standard output: then nothing else does.
  const bool prints_results_ = std::ranges::any_of(
      request_.outputs, [](const auto& output) { return isStandardOutput(output.second); });
  bool picture_failed_ = false;
  std::vector<fs::path> written_;
};

/// One name for a file, whatever it is called; the given one where there is none, as for a pipe.
fs::path oneName(const fs::path& path) {
  if (isStandardOutput(path)) return "-";
  std::error_code failed;
  fs::path name = fs::weakly_canonical(path, failed);
  return failed ? path : name;
}

/// Fails now rather than after a long run: a file cannot be written, or would overwrite a source or
/// another file of this run.
void requireWritable(const Plan& plan) {
  std::map<fs::path, std::string> taken;
  for (const PlanEntry& entry : plan.entries) {
    // The file, not the user, names this path.
    if (entry.original) requireBelow(fs::current_path(), entry.original->output_log);
    const Source& source = entry.source;
    const fs::path file =
        source.simulation ? source.simulation->input() : fs::path(source.reference.path);
    if (!file.empty()) taken[oneName(file)] = "a source";
  }
  const auto require = [&](const std::string& option, const fs::path& path) {
    const auto [other, free] = taken.emplace(oneName(path), option);
    if (!free) {
      throw InputError(fmt::format("{}: {}: already the file of {}: choose another name", option,
                                   path.string(), other->second));
    }
    requireOutput(path);
  };
  for (const auto& [name, path] : plan.request.outputs) require("--" + name, path);
  for (const PlanEntry& entry : plan.entries) {
    if (!entry.screenshot.empty()) require("--screenshot", entry.screenshot);
    if (entry.original) require("m_outputLog", entry.original->output_log);
  }
}

}  // namespace

int runHeadless(Plan plan, bool quiet) {
  if (plan.entries.empty()) throw InputError("no case is left to run after --filter and --shard");
  requireWritable(plan);
  if (!plan.request.record.empty()) makeDirectory(plan.request.record);
  const InterruptGuard guard;
  HeadlessRun run(plan.request, quiet);
  return run.finish(runPlan(plan, hostMaker(plan.request.hosts), run));
}

}  // namespace broadmark
