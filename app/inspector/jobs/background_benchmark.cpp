#include "inspector/jobs/background_benchmark.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/harness/runner.h"
#include "run/plan_run.h"
#include "support/output.h"
#include "support/words.h"

namespace broadmark {
namespace {

/// Updates the report of a run.
class Observer final : public RunObserver {
 public:
  Observer(BackgroundBenchmark& job, std::uint64_t steps)
      : job_(job), steps_(static_cast<double>(std::max<std::uint64_t>(steps, 1))) {}

  bool cancelled() override { return job_.cancelled(); }

  void onTaskStart(const std::string& task, std::uint64_t steps) override {
    task_ = task;
    task_start_ = task_end_;
    task_end_ += steps;
  }

  void onProgress(std::uint64_t done, const std::string& detail) override {
    const double fraction = std::min(1.0, static_cast<double>(task_start_ + done) / steps_);
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    job_.update([&](BenchmarkReport& report) {
      report.activity = detail.empty() ? task_ : fmt::format("{}: {}", task_, detail);
      report.fraction = static_cast<float>(fraction);
      report.seconds_left = fraction > 0 ? seconds * (1 - fraction) / fraction : 0;
    });
  }

  void onCaseFinished(const CaseResult& result) override {
    BenchmarkReport::Item item{
        .id = result.id,
        .name = fmt::format("{} · {}", caseNameOf(result), recordingId(result.recording)),
        .status = result.status,
        .reason = result.reason};
    if (!result.repetitions.empty()) item.median_seconds = result.summary().median;
    job_.update([&](BenchmarkReport& report) { report.items.push_back(std::move(item)); });
  }

  void onRecordingEnd(const PlanEntry& /*entry*/, IndexedFrames& /*recording*/, Oracle&) override {
    job_.update([](BenchmarkReport& report) {
      for (BenchmarkReport::Item& item : report.items) item.saved = true;
    });
  }

 private:
  using Clock = std::chrono::steady_clock;

  BackgroundBenchmark& job_;
  const double steps_;
  const Clock::time_point start_ = Clock::now();
  std::string task_;
  std::uint64_t task_start_ = 0;  ///< steps before the current task
  std::uint64_t task_end_ = 0;    ///< steps up to the end of the current task
};

}  // namespace

std::size_t BenchmarkReport::failed() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      items, [](const BenchmarkReport::Item& item) { return item.status != Status::ok; }));
}

std::string BenchmarkReport::text() const {
  std::string text = fmt::format("{} of {} run", items.size(), counted(cases, "case"));
  if (failed() > 0) text += fmt::format(", {} failed", failed());
  return text;
}

JobStatus BenchmarkReport::status() const {
  return {.activity = "Running algorithms: " + text() + ".",
          .outcome = failure.empty() ? fmt::format("{}: {}", file.string(), text()) : "",
          .is_error = failed() > 0,
          .values = {{"cases", std::to_string(cases)},
                     {"run", std::to_string(items.size())},
                     {"failed", std::to_string(failed())}}};
}

void startBenchmark(BackgroundBenchmark& job, RunRequest request, std::vector<Algorithm> algorithms,
                    const ExecutorFactory& make_executor, const SimulationHost& host) {
  const std::filesystem::path file = request.outputs.at("json");
  requireOutput(file);
  job.start({.file = file}, [&job, request = std::move(request), algorithms = std::move(algorithms),
                             make_executor, host] {
    job.update([](BenchmarkReport& report) { report.activity = "opening recordings"; });
    Plan plan = makePlan(request, PlanUse::run, algorithms);
    for (PlanEntry& entry : plan.entries) {
      std::unique_ptr<Simulation>& simulation = entry.source.simulation;
      if (simulation) simulation = host(std::move(simulation), [&job] { return job.cancelled(); });
    }
    job.update([&](BenchmarkReport& report) { report.cases = caseIds(plan).size(); });
    Observer observer(job, stepsOf(plan));
    return runPlan(plan, make_executor, observer).complete;
  });
}

}  // namespace broadmark
