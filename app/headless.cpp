// Recordings are taken one after the other. On each, repetitions of different cases are
// interleaved, so that a disturbance of the machine hits all of them alike. Result files are
// rewritten (each time atomically) after every recording: whatever ends the run, finished cases are
// kept.

#include "headless.h"

#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <map>
#include <memory>

#include "broadmark/compute_devices.h"
#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/runner.h"
#include "exit_status.h"
#include "interrupt.h"
#include "output.h"
#include "progress.h"
#include "recordings.h"
#include "result_files.h"
#include "screenshot.h"
#include "sweep.h"
#include "table.h"
#include "warnings.h"
#include "words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Which variants crossed the time limit on a smaller scene of the same kind: they are not run on
/// larger ones (the paper's rule).
class Exhausted {
 public:
  void note(const CaseResult& result, const Case& run) {
    if (result.status != Status::timeout) return;
    const std::uint32_t objects = result.recording.scene.objects;
    std::uint32_t& smallest = smallest_.try_emplace(key(result, run), objects).first->second;
    smallest = std::min(smallest, objects);
  }
  /// Whether a case is not to be run; then its result says so.
  bool skip(CaseResult& result, const Case& run) const {
    const auto found = smallest_.find(key(result, run));
    if (found == smallest_.end() || found->second > result.recording.scene.objects) return false;
    result.status = Status::timeout;
    result.reason = fmt::format("not run: crossed the time limit with {}",
                                counted(found->second, "body", "bodies"));
    return true;
  }

 private:
  static std::string key(const CaseResult& result, const Case& run) {
    const SceneInfo& scene = result.recording.scene;
    return fmt::format("{}/{}{}/{}", scene.name, scene.object_type,
                       sweptText(result.recording.swept), caseName(run));
  }
  std::map<std::string, std::uint32_t> smallest_;
};

/// All cases of one recording, run in turn.
class EntryRun {
 public:
  /// All arguments outlive this.
  EntryRun(const PlanEntry& entry, const SessionOptions& options, Exhausted& exhausted,
           RunWarnings& warnings, ResultFiles& files)
      : cases_(entry.cases),
        options_(options),
        make_host_(hostMaker(options.hosts)),
        exhausted_(exhausted),
        files_(files),
        runs_(cases_.size()),
        ended_(cases_.size()),
        order_(cases_.size(), options.repetitions.order_seed) {
    for (const Case& run : cases_) {
      results_.push_back(beginCase(run, entry.source.reference));
      Conditions& conditions = results_.back().conditions = commonConditions();
      conditions.plugin = run.algorithm.plugin_build;
      conditions.warnings = warnings.of(run);
    }
  }

  /// Runs all repetitions, interleaved. Returns false when interrupted.
  bool run(IndexedFrames& recording, Oracle& oracle) {
    const int passes = options_.warmup + options_.repetitions.most;
    const SceneInfo& scene = recording.scene();
    const auto steps_of = [&](int some_passes) {
      return std::uint64_t{scene.frames} * static_cast<std::uint64_t>(some_passes);
    };
    Progress progress(fmt::format("running {} N{}", scene.name, scene.objects),
                      steps_of(passes) * cases_.size(), options_.quiet);
    std::uint64_t steps = 0;
    const RunHooks hooks{.cancelled = InterruptGuard::requested,
                         .progress = [&](std::uint32_t frame) { progress.update(steps + frame); }};
    const RepetitionRule rule(options_.repetitions);
    for (int pass = 0; pass < passes; ++pass) {
      if (passes > 1) order_.shuffle();
      for (const std::size_t i : order_.cases()) {
        if (ended_[i]) continue;
        progress.detail(cases_[i].algorithm.id);
        if (!runOnce(i, recording, oracle, hooks, pass >= options_.warmup)) return false;
        steps += steps_of(1);
        if (results_[i].status != Status::ok || rule.isEnough(results_[i])) {
          results_[i].conditions.repetitions = rule.wanted(results_[i]);
          end(i);
          steps += steps_of(passes - 1 - pass);
        }
        // Its process is not needed any more, or would be one of too many.
        if (ended_[i] || cases_.size() > kMostHeld) runs_[i].reset();
        progress.update(steps);
      }
    }
    return true;
  }

  /// Of the cases that have been run.
  std::vector<CaseResult> takeResults() {
    for (std::size_t i = 0; i < results_.size(); ++i) {
      if (!results_[i].repetitions.empty()) end(i);  // interrupted, after some of its passes
    }
    std::erase_if(results_, [](const CaseResult& result) {
      return result.status == Status::ok && result.repetitions.empty();
    });
    return std::move(results_);
  }

 private:
  /// Of more cases than these none keeps its process, with threads and device, between two passes.
  static constexpr std::size_t kMostHeld = 64;

  /// One repetition of one case, unless it has failed already. Returns false when interrupted.
  bool runOnce(std::size_t i, IndexedFrames& recording, Oracle& oracle, const RunHooks& hooks,
               bool measured) {
    CaseResult& result = results_[i];
    if (result.status != Status::ok || exhausted_.skip(result, cases_[i])) return true;
    if (!runs_[i]) {
      runs_[i] = std::make_unique<CaseRun>(cases_[i], options_.policy, make_host_,
                                           InterruptGuard::requested);
    }
    const YardstickTimes yardsticks = measured ? yardsticks_.recent() : YardstickTimes();
    const std::size_t before = result.repetitions.size();
    if (!runRepetition(result, *runs_[i], recording, oracle, hooks, measured)) return false;
    if (result.repetitions.size() > before) result.repetitions.back().yardsticks = yardsticks;
    exhausted_.note(result, cases_[i]);
    return true;
  }

  /// Keeps the result of a case that will not be run any more.
  void end(std::size_t i) {
    if (!ended_[i]) files_.add(results_[i]);
    ended_[i] = true;
  }

  [[nodiscard]] Conditions commonConditions() const {
    const auto limit = [](double seconds) {
      return std::isfinite(seconds) ? std::optional(seconds) : std::nullopt;
    };
    const HostOptions& hosts = options_.hosts;
    return {.check = options_.policy.check,
            .warmup = options_.warmup,
            .repetitions = options_.repetitions.most,
            .frame_limit_seconds = limit(options_.policy.frame_limit_seconds),
            .initialize_limit_seconds = limit(options_.policy.initialize_limit_seconds),
            .call_limit_seconds =
                hosts.in_process ? std::nullopt : std::optional(hosts.hard_limit_seconds),
            .in_process = hosts.in_process,
            .load_average = thisEnvironment().load_average};
  }

  const std::vector<Case>& cases_;
  const SessionOptions& options_;
  HostMaker make_host_;
  Exhausted& exhausted_;
  ResultFiles& files_;
  Yardsticks yardsticks_;
  // In the order of the cases.
  std::vector<CaseResult> results_;
  std::vector<std::unique_ptr<CaseRun>> runs_;  ///< null before the first and after the last pass
  std::vector<bool> ended_;
  TurnOrder order_;
};

/// A whole plan, run entry by entry.
class PlanRun {
 public:
  PlanRun(const SessionOptions& options, const Plan& plan) : options_(options) {
    results_.environments = {environmentOf(plan.entries.front().cases.front().device)};
    results_.options = options.command_line;
    warnings_.emplace(results_.environments.front());
    files_.emplace(options.outputs, results_);
  }

  void run(Plan& plan) {
    for (PlanEntry& entry : plan.entries) {
      runEntry(entry);
      if (interrupted_) return;
    }
  }

  /// Prints the results that go to standard output, and says what has been written. Returns the
  /// exit status. Throws Interrupted.
  int finish() {
    if (!options_.record.empty()) written_.push_back(options_.record);
    results_.complete = !interrupted_;
    files_->end(results_);
    if (!results_.cases.empty()) {
      for (const auto& [name, path] : options_.outputs) {
        if (!isStandardOutput(path)) written_.push_back(path);
      }
    }
    for (const fs::path& path : written_) {
      fmt::print(prints_results_ ? stderr : stdout, "written: {}\n", path.string());
    }
    if (interrupted_ || InterruptGuard::requested()) {
      throw Interrupted(fmt::format("{} kept", counted(results_.cases.size(), "finished case")));
    }
    const int status = exitStatusOf(judgedStatuses());
    return picture_failed_ && status != exit_status::wrong_answer ? exit_status::bad_input : status;
  }

 private:
  /// Those that tell how the run ends.
  [[nodiscard]] std::vector<Status> judgedStatuses() const {
    std::vector<Status> statuses;
    for (const CaseResult& result : results_.cases) statuses.push_back(result.status);
    if (options_.allow_timeout) std::erase(statuses, Status::timeout);
    return statuses;
  }

  /// The machine, with the compute device that is used before the others.
  static Environment environmentOf(const std::string& wanted_device) {
    Environment environment = thisEnvironment();
    std::vector<ComputeDevice> devices = computeDevices();
    if (devices.empty() && wanted_device.empty()) return environment;
    const auto chosen =
        devices.begin() + static_cast<std::ptrdiff_t>(chooseDevice(devices, wanted_device));
    std::rotate(devices.begin(), chosen, chosen + 1);
    for (const ComputeDevice& device : devices) {
      environment.compute_devices.push_back(describe(device));
    }
    return environment;
  }

  void runEntry(PlanEntry& entry) {
    const auto recording =
        openRecording(entry.source, options_.record, options_.scene.recorders, options_.quiet);
    if (!recording) {
      interrupted_ = true;
      return;
    }
    Oracle oracle;
    EntryRun run(entry, options_, exhausted_, *warnings_, *files_);
    try {
      interrupted_ = !run.run(*recording, oracle);
    } catch (...) {
      keepFinished(entry, run);
      throw;
    }
    report(entry, run.takeResults());
    if (!entry.screenshot.empty() && !interrupted_) draw(*recording, oracle, entry.screenshot);
  }

  /// What ends the run costs no case that was finished before.
  void keepFinished(const PlanEntry& entry, EntryRun& run) {
    try {
      report(entry, run.takeResults());
    } catch (const InputError&) {  // what went wrong first is what the user hears of
    }
  }

  void report(const PlanEntry& entry, const std::vector<CaseResult>& done) {
    if (done.empty()) return;
    if (!prints_results_) std::cout << formatTable(done) << std::endl;
    if (entry.original) {
      const fs::path log = entry.original->output_log;
      writeTextFile(log, formatOriginalLog(*entry.original, done.front()));
      written_.push_back(log);
    }
    results_.cases.insert(results_.cases.end(), done.begin(), done.end());
    files_->rewrite(results_);
  }

  void draw(IndexedFrames& recording, Oracle& oracle, const fs::path& path) {
    try {
      takeScreenshot(recording, options_.frame.value_or(recording.scene().frames), oracle,
                     options_.picture, path);
      written_.push_back(path);
    } catch (const RenderError& error) {
      std::cerr << fmt::format("broadmark: no screenshot: {}\n", error.what());
      picture_failed_ = true;
    }
  }

  const SessionOptions& options_;
  /// Results go to standard output: then nothing else does.
  const bool prints_results_ = std::ranges::any_of(
      options_.outputs, [](const auto& output) { return isStandardOutput(output.second); });
  Results results_;
  std::optional<RunWarnings> warnings_;
  std::optional<ResultFiles> files_;
  Exhausted exhausted_;
  bool picture_failed_ = false;
  bool interrupted_ = false;
  std::vector<fs::path> written_;
};

/// Every file that the run will write, with the option that asks for it.
std::vector<std::pair<std::string, fs::path>> plannedFiles(const SessionOptions& options,
                                                           const Plan& plan) {
  std::vector<std::pair<std::string, fs::path>> files;
  for (const auto& [name, path] : options.outputs) files.emplace_back("--" + name, path);
  for (const PlanEntry& entry : plan.entries) {
    if (!entry.screenshot.empty()) files.emplace_back("--screenshot", entry.screenshot);
    if (entry.original) files.emplace_back("m_outputLog", entry.original->output_log);
  }
  return files;
}

/// One name for a file, whatever it is called; the given one where there is none, as for a pipe.
fs::path oneName(const fs::path& path) {
  if (isStandardOutput(path)) return "-";
  std::error_code failed;
  fs::path name = fs::weakly_canonical(path, failed);
  return failed ? path : name;
}

/// Fails now rather than after a long run: a file cannot be written, or would overwrite a source or
/// another file of this run.
void requireWritable(const SessionOptions& options, const Plan& plan) {
  std::map<fs::path, std::string> taken;
  for (const PlanEntry& entry : plan.entries) {
    // This is named by a file, not by who runs it.
    if (entry.original) requireBelow(fs::current_path(), entry.original->output_log);
    const Source& source = entry.source;
    const fs::path file =
        source.simulation ? source.simulation->input() : fs::path(source.reference.path);
    if (!file.empty()) taken[oneName(file)] = "a source";
  }
  for (const auto& [option, path] : plannedFiles(options, plan)) {
    const auto [other, free] = taken.emplace(oneName(path), option);
    if (!free) {
      throw InputError(fmt::format("{}: {}: already the file of {}: choose another name", option,
                                   path.string(), other->second));
    }
    requireOutput(path);
  }
}

}  // namespace

int runHeadless(Plan plan, const SessionOptions& options) {
  if (plan.entries.empty()) throw InputError("no case is left to run after --filter and --shard");
  requireWritable(options, plan);
  if (!options.record.empty()) makeDirectory(options.record);
  const InterruptGuard guard;
  PlanRun run(options, plan);
  run.run(plan);
  return run.finish();
}

}  // namespace broadmark
