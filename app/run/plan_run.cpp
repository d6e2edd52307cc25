// Recordings are taken one after the other. On each, repetitions of different cases are
// interleaved, so that a disturbance of the machine hits all of them alike. Result files are
// rewritten (each time atomically) after every recording: whatever ends the run, finished cases are
// kept.

#include "run/plan_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "broadmark/compute_devices.h"
#include "broadmark/error.h"
#include "broadmark/harness/runner.h"
#include "request/sweep.h"
#include "run/recordings.h"
#include "run/result_files.h"
#include "run/warnings.h"
#include "support/words.h"

namespace broadmark {
namespace {

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
  EntryRun(const PlanEntry& entry, const SessionOptions& options, const HostMaker& make_host,
           Exhausted& exhausted, RunWarnings& warnings, ResultFiles& files, RunWatcher& watcher)
      : cases_(entry.cases),
        options_(options),
        make_host_(make_host),
        exhausted_(exhausted),
        files_(files),
        watcher_(watcher),
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
    watcher_.begins(scene, steps_of(passes) * cases_.size());
    std::uint64_t steps = 0;
    std::string algorithm;
    const RunHooks hooks{
        .cancelled = [this] { return watcher_.cancelled(); },
        .progress = [&](std::uint32_t frame) { watcher_.advances(steps + frame, algorithm); }};
    const RepetitionRule rule(options_.repetitions);
    for (int pass = 0; pass < passes; ++pass) {
      if (passes > 1) order_.shuffle();
      for (const std::size_t i : order_.cases()) {
        if (ended_[i]) continue;
        algorithm = cases_[i].algorithm.id;
        if (!runOnce(i, recording, oracle, hooks, pass >= options_.warmup)) return false;
        steps += steps_of(1);
        if (results_[i].status != Status::ok || rule.isEnough(results_[i])) {
          results_[i].conditions.repetitions = rule.wanted(results_[i]);
          end(i);
          steps += steps_of(passes - 1 - pass);
        }
        // Its process is not needed any more, or would be one of too many.
        if (ended_[i] || cases_.size() > kMostHeld) runs_[i].reset();
        watcher_.advances(steps, algorithm);
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
                                           [this] { return watcher_.cancelled(); });
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
    if (ended_[i]) return;
    files_.add(results_[i]);
    ended_[i] = true;
    watcher_.ended(results_[i]);
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
  const HostMaker& make_host_;
  Exhausted& exhausted_;
  ResultFiles& files_;
  RunWatcher& watcher_;
  Yardsticks yardsticks_;
  // In the order of the cases.
  std::vector<CaseResult> results_;
  std::vector<std::unique_ptr<CaseRun>> runs_;  ///< null before the first and after the last pass
  std::vector<bool> ended_;
  TurnOrder order_;
};

/// The machine, with the compute device that is used before the others.
Environment environmentOf(const std::string& wanted_device) {
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

/// A whole plan, run entry by entry.
class PlanRun {
 public:
  PlanRun(const SessionOptions& options, const HostMaker& make_host, RunWatcher& watcher,
          const Plan& plan)
      : options_(options), make_host_(make_host), watcher_(watcher) {
    results_.environments = {environmentOf(plan.entries.front().cases.front().device)};
    results_.options = options.command_line;
    warnings_.emplace(results_.environments.front());
    files_.emplace(options.outputs, results_);
  }

  Results run(Plan& plan) {
    results_.complete =
        std::ranges::all_of(plan.entries, [this](PlanEntry& entry) { return runEntry(entry); });
    files_->end(results_);
    return std::move(results_);
  }

 private:
  /// Returns false when it was ended.
  bool runEntry(PlanEntry& entry) {
    const auto recording =
        openRecording(entry.source, options_.record, options_.scene.recorders, options_.quiet);
    if (!recording) return false;
    Oracle oracle;
    EntryRun run(entry, options_, make_host_, exhausted_, *warnings_, *files_, watcher_);
    bool went_on = false;
    try {
      went_on = run.run(*recording, oracle);
    } catch (...) {
      keepFinished(entry, run);
      throw;
    }
    keep(entry, run.takeResults());
    if (went_on) watcher_.leaves(entry, *recording, oracle);
    return went_on;
  }

  /// What ends the run costs no case that was finished before.
  void keepFinished(const PlanEntry& entry, EntryRun& run) {
    try {
      keep(entry, run.takeResults());
    } catch (const InputError&) {  // what went wrong first is what the user hears of
    }
  }

  void keep(const PlanEntry& entry, const std::vector<CaseResult>& done) {
    if (done.empty()) return;
    watcher_.ran(entry, done);
    results_.cases.insert(results_.cases.end(), done.begin(), done.end());
    files_->rewrite(results_);
  }

  const SessionOptions& options_;
  const HostMaker& make_host_;
  RunWatcher& watcher_;
  Results results_;
  std::optional<RunWarnings> warnings_;
  std::optional<ResultFiles> files_;
  Exhausted exhausted_;
};

}  // namespace

Results runPlan(Plan& plan, const SessionOptions& options, const HostMaker& make_host,
                RunWatcher& watcher) {
  return PlanRun(options, make_host, watcher, plan).run(plan);
}

}  // namespace broadmark
