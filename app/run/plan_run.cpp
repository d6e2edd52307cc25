// Runs recordings one after the other. The repetitions of a recording's cases are interleaved, so
// that a disturbance of the machine affects all cases alike, and each has its own process, as times
// differ between processes by where memory lies. Result files are atomically rewritten
// after every recording, so that finished cases survive an aborted run.

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

/// Variants that exceeded the time limit on a smaller scene of the same kind: they are not run on
/// larger ones (the paper's rule).
class TimedOutVariants {
 public:
  void add(const CaseResult& result, const Case& test_case) {
    if (result.status != Status::timeout) return;
    const std::uint32_t objects = result.recording.scene.objects;
    std::uint32_t& smallest = smallest_.try_emplace(key(result, test_case), objects).first->second;
    smallest = std::min(smallest, objects);
  }
  /// Returns whether to skip a case; if so, sets its result.
  bool skip(CaseResult& result, const Case& test_case) const {
    const auto found = smallest_.find(key(result, test_case));
    if (found == smallest_.end() || found->second > result.recording.scene.objects) return false;
    result.status = Status::timeout;
    result.reason = fmt::format("not run: exceeded the time limit with {}",
                                counted(found->second, "body", "bodies"));
    return true;
  }

 private:
  static std::string key(const CaseResult& result, const Case& test_case) {
    const SceneInfo& scene = result.recording.scene;
    return fmt::format("{}/{}{}/{}", scene.name, scene.object_type,
                       sweptText(result.recording.swept), caseName(test_case));
  }
  std::map<std::string, std::uint32_t> smallest_;
};

/// The machine's environment, with the selected compute device first.
Environment environmentOf(const std::string& requested_device) {
  Environment environment = thisEnvironment();
  std::vector<ComputeDevice> devices = computeDevices();
  if (devices.empty() && requested_device.empty()) return environment;
  const auto chosen =
      devices.begin() + static_cast<std::ptrdiff_t>(chooseDevice(devices, requested_device));
  std::rotate(devices.begin(), chosen, chosen + 1);
  for (const ComputeDevice& device : devices) {
    environment.compute_devices.push_back(describe(device));
  }
  return environment;
}

/// Frames that a repetition of a case runs, warm-up included.
std::uint64_t stepsOfRepetition(const RunRequest& request, const SceneInfo& scene) {
  return std::min<std::uint64_t>(scene.frames, request.policy.max_frames) *
         static_cast<std::uint64_t>(request.repetitions.warmup + 1);
}

/// A case of the current recording.
struct PlannedCase {
  const Case* test_case = nullptr;
  CaseResult result;
  bool finished = false;  ///< has no more repetitions
};

class PlanRun {
 public:
  /// All arguments must outlive this.
  PlanRun(Plan& plan, const ExecutorFactory& make_executor, RunObserver& observer)
      : plan_(plan),
        request_(plan.request),
        make_executor_(make_executor),
        observer_(observer),
        results_{.environments = {environmentOf(plan.entries.front().cases.front().device)},
                 .options = plan.request.command_line},
        warnings_(results_.environments.front()),
        files_(plan.request.outputs, results_) {}

  Results run() {
    results_.complete = std::ranges::all_of(
        plan_.entries, [this](PlanEntry& entry) { return runRecording(entry); });
    files_.finish(results_);
    return std::move(results_);
  }

 private:
  /// Runs all cases of a recording. Returns false when cancelled.
  bool runRecording(PlanEntry& entry) {
    const auto recording =
        openRecording(entry.source, observer_, request_.record, request_.scene.recorders);
    if (!recording) return false;
    Oracle oracle(Oracle::kBudgetBytes, kUnlimitedPairs, [this] { return observer_.cancelled(); });
    cases_.clear();
    for (const Case& test_case : entry.cases)
      cases_.push_back(plannedCase(test_case, entry.source));
    bool is_complete = false;
    try {
      is_complete = runRepetitions(*recording, oracle);
    } catch (...) {
      try {
        storeResults(entry);
      } catch (const InputError&) {  // NOLINT(bugprone-empty-catch): the first error is reported
      }
      throw;
    }
    storeResults(entry);
    if (!is_complete) return false;
    try {
      observer_.onRecordingEnd(entry, *recording, oracle);
    } catch (const Cancelled&) {
      return false;
    }
    return true;
  }

  PlannedCase plannedCase(const Case& test_case, const Source& source) {
    PlannedCase planned{.test_case = &test_case, .result = beginCase(test_case, source.reference)};
    planned.result.conditions = commonConditions();
    planned.result.conditions.plugin = test_case.algorithm.plugin_build;
    // Noise distorts times only.
    if (!request_.policy.counted_by) {
      planned.result.conditions.warnings = warnings_.warningsFor(test_case);
    }
    return planned;
  }

  /// Runs all repetitions, interleaved. Returns false when cancelled.
  bool runRepetitions(IndexedFrames& recording, Oracle& oracle) {
    const RepetitionOptions& repetitions = request_.repetitions;
    const SceneInfo& scene = recording.scene();
    const auto count = static_cast<std::uint64_t>(repetitions.max_count);
    const std::uint64_t steps_of_repetition = stepsOfRepetition(request_, scene);
    observer_.onTaskStart(fmt::format("running {} N{}", scene.name, scene.objects),
                          steps_of_repetition * count * cases_.size());
    const RepetitionRule rule(repetitions);
    TurnOrder order(cases_.size(), repetitions.order_seed);
    std::uint64_t steps = 0;
    for (std::uint64_t repetition = 0; repetition < count; ++repetition) {
      if (count > 1) order.shuffle();
      for (const std::size_t i : order.cases()) {
        PlannedCase& planned = cases_[i];
        if (planned.finished) continue;
        if (!runOnce(planned, recording, oracle, steps)) return false;
        steps += steps_of_repetition;
        CaseResult& result = planned.result;
        if (result.status != Status::ok || rule.isEnough(result)) {
          result.conditions.repetitions = rule.expected(result);
          if (result.status == Status::ok && !rule.isPrecise(result)) warnImprecise(result);
          finish(planned);
          steps += steps_of_repetition * (count - 1 - repetition);
        }
        observer_.onProgress(steps, planned.test_case->algorithm.id);
      }
    }
    return true;
  }

  /// Adds a warning to a case whose mean is not precise. It is printed after the results.
  void warnImprecise(CaseResult& result) {
    const Summary summary = result.summary();
    const auto percent = [](double share) { return fmt::format("{:.3g} %", 100 * share); };
    const std::string width =
        summary.ci95 ? percent((summary.ci95->high - summary.ci95->low) / summary.seconds_per_frame)
                     : "unknown";
    const std::string warning =
        fmt::format("--precision {} not reached: the mean's 95 % interval is {} wide after {}",
                    percent(request_.repetitions.precision), width,
                    counted(result.repetitions.size(), "repetition"));
    result.conditions.warnings.push_back(warning);
    later_warnings_.push_back(fmt::format("{}: {}", result.id, warning));
  }

  /// Runs a repetition of a case in a new executor, after its warm-up, unless the case is skipped.
  /// Returns false when cancelled.
  bool runOnce(PlannedCase& planned, IndexedFrames& recording, Oracle& oracle,
               std::uint64_t steps) {
    CaseResult& result = planned.result;
    const Case& test_case = *planned.test_case;
    if (timed_out_.skip(result, test_case)) return true;
    const auto cancelled = [this] { return observer_.cancelled(); };
    const RunHooks hooks{.cancelled = cancelled, .progress = [&](std::uint32_t frame) {
                           observer_.onProgress(steps + frame, test_case.algorithm.id);
                         }};
    CaseRun case_run(test_case, request_.policy, make_executor_, cancelled);
    for (int pass = request_.repetitions.warmup; pass >= 0 && result.status == Status::ok; --pass) {
      if (!runRepetition(result, case_run, recording, oracle, hooks, pass == 0)) return false;
    }
    timed_out_.add(result, test_case);
    return true;
  }

  /// Stores the result of a case after its last repetition.
  void finish(PlannedCase& planned) {
    files_.add(planned.result);
    planned.finished = true;
    observer_.onCaseFinished(planned.result);
  }

  /// Stores the results of all cases that have run at least one repetition.
  void storeResults(const PlanEntry& entry) {
    std::vector<CaseResult> done;
    for (PlannedCase& planned : cases_) {
      const bool measured = !planned.result.repetitions.empty();
      if (measured && !planned.finished) finish(planned);
      if (measured || planned.result.status != Status::ok) {
        done.push_back(std::move(planned.result));
      }
    }
    if (done.empty()) return;
    observer_.onRecordingResults(entry, done);
    for (const std::string& warning : std::exchange(later_warnings_, {})) {
      RunWarnings::print(warning);
    }
    std::ranges::move(done, std::back_inserter(results_.cases));
    files_.rewrite(results_);
  }

  [[nodiscard]] Conditions commonConditions() const {
    const auto limit = [](double seconds) {
      return std::isfinite(seconds) ? std::optional(seconds) : std::nullopt;
    };
    const HostOptions& hosts = request_.hosts;
    return {.check = request_.policy.check,
            .warmup = request_.repetitions.warmup,
            .repetitions = request_.repetitions.max_count,
            .frame_limit_seconds = limit(request_.policy.frame_limit_seconds),
            .initialize_limit_seconds = limit(request_.policy.initialize_limit_seconds),
            .call_limit_seconds =
                hosts.in_process ? std::nullopt : std::optional(hosts.hard_limit_seconds),
            .in_process = hosts.in_process,
            .load_average = thisEnvironment().load_average};
  }

  Plan& plan_;
  const RunRequest& request_;
  const ExecutorFactory& make_executor_;
  RunObserver& observer_;
  Results results_;
  RunWarnings warnings_;
  std::vector<std::string> later_warnings_;
  ResultFiles files_;
  TimedOutVariants timed_out_;
  std::vector<PlannedCase> cases_;  ///< of the current recording
};

}  // namespace

std::uint64_t stepsOf(const Plan& plan) {
  const RunRequest& request = plan.request;
  std::uint64_t steps = 0;
  for (const PlanEntry& entry : plan.entries) {
    steps += stepsOfRepetition(request, entry.source.reference.scene) * entry.cases.size() *
             static_cast<std::uint64_t>(request.repetitions.max_count);
  }
  return steps;
}

Results runPlan(Plan& plan, const ExecutorFactory& make_executor, RunObserver& observer) {
  return PlanRun(plan, make_executor, observer).run();
}

}  // namespace broadmark
