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

/// Keeps the report of a run up to date.
class Observer final : public RunObserver {
 public:
  Observer(BackgroundBenchmark& job, std::uint64_t steps)
      : job_(job), steps_(static_cast<double>(std::max<std::uint64_t>(steps, 1))) {}

  bool cancelled() override { return job_.cancelled(); }

  void onTaskStart(const std::string& task, std::uint64_t steps) override {
    doing_ = task;
    begun_ = next_;
    next_ += steps;
  }

  void onProgress(std::uint64_t done, const std::string& detail) override {
    const double share = std::min(1.0, static_cast<double>(begun_ + done) / steps_);
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    job_.update([&](BenchmarkReport& report) {
      report.doing = detail.empty() ? doing_ : fmt::format("{}: {}", doing_, detail);
      report.fraction = static_cast<float>(share);
      report.seconds_left = share > 0 ? seconds * (1 - share) / share : 0;
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
      for (BenchmarkReport::Item& item : report.items) item.kept = true;
    });
  }

 private:
  using Clock = std::chrono::steady_clock;

  BackgroundBenchmark& job_;
  const double steps_;
  const Clock::time_point start_ = Clock::now();
  std::string doing_;
  std::uint64_t begun_ = 0;  ///< steps of the tasks before
  std::uint64_t next_ = 0;   ///< steps of the tasks up to the present one
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
  return {.doing = "Running algorithms: " + text() + ".",
          .outcome = failure.empty() ? fmt::format("{}: {}", file.string(), text()) : "",
          .faulty = failed() > 0,
          .values = {{"cases", std::to_string(cases)},
                     {"run", std::to_string(items.size())},
                     {"failed", std::to_string(failed())}}};
}

void startBenchmark(BackgroundBenchmark& job, RunRequest request, std::vector<Algorithm> algorithms,
                    const ExecutorFactory& make_host) {
  const std::filesystem::path file = request.outputs.at("json");
  requireOutput(file);
  job.begin({.file = file},
            [&job, request = std::move(request), algorithms = std::move(algorithms), make_host] {
              job.update([](BenchmarkReport& report) { report.doing = "opening recordings"; });
              Plan plan = makePlan(request, PlanUse::run, algorithms);
              job.update([&](BenchmarkReport& report) { report.cases = caseIds(plan).size(); });
              Observer observer(job, stepsOf(plan));
              return runPlan(plan, make_host, observer).complete;
            });
}

}  // namespace broadmark
