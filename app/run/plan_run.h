// Runs a plan: its recordings one after the other, the cases of each interleaved.
#pragma once

#include <span>

#include "broadmark/harness/case_executor.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/results/results.h"
#include "run/plan.h"
#include "support/progress.h"

namespace broadmark {

/// Callbacks for a running plan, called on the thread that runs it. The cases of a recording are a
/// task with a step per frame; its detail is the algorithm.
class RunObserver : public TaskObserver {
 public:
  /// Called after the last pass of a case.
  virtual void onCaseFinished(const CaseResult& /*result*/) {}
  /// Called with the results of an entry before they are stored; not called without results.
  virtual void onRecordingResults(const PlanEntry& /*entry*/,
                                  std::span<const CaseResult> /*results*/) {}
  /// Called when all cases of an entry have run, after its results are stored.
  virtual void onRecordingEnd(const PlanEntry& /*entry*/, IndexedFrames& /*recording*/, Oracle&) {}
};

/// Total number of steps of the tasks of a plan's cases.
std::uint64_t stepsOf(const Plan& plan);

/// Opens or simulates the plan's recordings, then runs, checks and measures every case. Keeps the
/// requested result files up to date. Returns the results; incomplete if the observer cancelled the
/// run. Throws InputError; the files then contain the finished cases.
Results runPlan(Plan& plan, const ExecutorFactory& make_executor, RunObserver& observer);

}  // namespace broadmark
