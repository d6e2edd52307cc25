// Running a plan: its recordings one after the other, the cases of each in turn.
#pragma once

#include <span>

#include "broadmark/harness/case_executor.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/results/results.h"
#include "run/plan.h"
#include "support/progress.h"

namespace broadmark {

/// Callbacks for a running plan, made by the thread that runs it. The cases of a recording are a
/// task with a step per frame; its detail is the algorithm.
class RunObserver : public TaskObserver {
 public:
  /// A case will not be run any more.
  virtual void onCaseFinished(const CaseResult& /*result*/) {}
  /// The results of an entry, before they are kept. Not called without any.
  virtual void onRecordingResults(const PlanEntry& /*entry*/,
                                  std::span<const CaseResult> /*results*/) {}
  /// An entry has been run to its end, and its results are kept.
  virtual void onRecordingEnd(const PlanEntry& /*entry*/, IndexedFrames& /*recording*/, Oracle&) {}
};

/// How many steps the tasks of a plan's cases have together.
std::uint64_t stepsOf(const Plan& plan);

/// Opens or simulates the plan's recordings, runs every case on them, checks and measures. The
/// result files that the request names are kept up to date. Returns what has been run; complete
/// unless the observer has ended it. Throws InputError; finished cases are in the files then.
Results runPlan(Plan& plan, const ExecutorFactory& make_host, RunObserver& observer);

}  // namespace broadmark
