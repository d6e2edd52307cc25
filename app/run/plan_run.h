// Running a plan: its recordings one after the other, the cases of each in turn.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "broadmark/harness/case_host.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/results/results.h"
#include "command_line/session_options.h"
#include "run/plan.h"

namespace broadmark {

/// Who looks on while a plan is run. All calls are made by the thread that runs it.
class RunWatcher {
 public:
  virtual ~RunWatcher() = default;

  /// Asked between frames; true ends the run, and what is finished is kept.
  virtual bool cancelled() = 0;
  /// The cases of a recording begin; together they take so many steps.
  virtual void begins(const SceneInfo& scene, std::uint64_t steps) = 0;
  /// So many steps are done; the next ones are of this algorithm.
  virtual void advances(std::uint64_t done, const std::string& algorithm) = 0;
  /// A case will not be run any more.
  virtual void ended(const CaseResult& /*result*/) {}
  /// The results of an entry, which are kept next. Not called without any.
  virtual void ran(const PlanEntry& /*entry*/, std::span<const CaseResult> /*results*/) {}
  /// An entry has been run to its end, and its results are kept.
  virtual void leaves(const PlanEntry& /*entry*/, IndexedFrames& /*recording*/, Oracle&) {}
};

/// Opens or simulates the plan's recordings, runs every case on them, checks and measures. The
/// result files that the options name are kept up to date. Returns what has been run; complete
/// unless the watcher has ended it. Throws InputError; finished cases are in the files then.
Results runPlan(Plan& plan, const SessionOptions& options, const HostMaker& make_host,
                RunWatcher& watcher);

}  // namespace broadmark
