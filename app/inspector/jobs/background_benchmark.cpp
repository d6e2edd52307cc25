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

std::uint64_t stepsOf(const Plan& plan, const SessionOptions& options) {
  const auto passes = static_cast<std::uint64_t>(options.warmup) +
                      static_cast<std::uint64_t>(options.repetitions.most);
  std::uint64_t steps = 0;
  for (const PlanEntry& entry : plan.entries) {
    steps += passes * entry.cases.size() * entry.source.reference.scene.frames;
  }
  return std::max<std::uint64_t>(steps, 1);
}

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

JobStatus BackgroundBenchmark::statusOf(const Report& report) const {
  return {.doing = "Running algorithms: " + report.text() + ".",
          .outcome = report.failure.empty()
                         ? fmt::format("{}: {}", report.file.string(), report.text())
                         : "",
          .faulty = report.failed() > 0,
          .values = {{"cases", std::to_string(report.cases)},
                     {"run", std::to_string(report.items.size())},
                     {"failed", std::to_string(report.failed())}}};
}

/// Puts into the report what a run tells.
class BackgroundBenchmark::Watcher final : public RunWatcher {
 public:
  Watcher(BackgroundBenchmark& job, std::uint64_t steps) : job_(job), steps_(steps) {}

  bool cancelled() override { return job_.cancelled(); }

  void begins(const SceneInfo& scene, std::uint64_t steps) override {
    scene_ = fmt::format("{} {} N{}", scene.name, scene.object_type, scene.objects);
    begun_ = next_;
    next_ += steps;
  }

  void advances(std::uint64_t done, const std::string& algorithm) override {
    const double share = static_cast<double>(begun_ + done) / static_cast<double>(steps_);
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    job_.update([&](Report& report) {
      report.doing = fmt::format("{}: {}", scene_, algorithm);
      report.fraction = static_cast<float>(share);
      report.seconds_left = share > 0 ? seconds * (1 - share) / share : 0;
    });
  }

  void ended(const CaseResult& result) override {
    BenchmarkReport::Item item{
        .id = result.id,
        .name = fmt::format("{} · {}", caseNameOf(result), recordingId(result.recording)),
        .status = result.status,
        .reason = result.reason};
    if (!result.repetitions.empty()) item.median_seconds = result.summary().median;
    job_.update([&](Report& report) { report.items.push_back(std::move(item)); });
  }

  void leaves(const PlanEntry& /*entry*/, IndexedFrames& /*recording*/, Oracle&) override {
    job_.update([](Report& report) {
      for (BenchmarkReport::Item& item : report.items) item.kept = true;
    });
  }

 private:
  using Clock = std::chrono::steady_clock;

  BackgroundBenchmark& job_;
  const std::uint64_t steps_;
  const Clock::time_point start_ = Clock::now();
  std::string scene_;
  std::uint64_t begun_ = 0;  ///< steps of the recordings before
  std::uint64_t next_ = 0;   ///< those with this one's
};

void BackgroundBenchmark::start(SessionOptions options, std::vector<Algorithm> algorithms,
                                std::filesystem::path file, const HostMaker& make_host) {
  requireOutput(file);
  options.outputs = {{"json", file}};
  options.headless = options.quiet = true;
  begin({.file = file},
        [this, options = std::move(options), algorithms = std::move(algorithms), make_host] {
          update([](Report& report) { report.doing = "opening recordings"; });
          Plan plan = makePlan(options, algorithms);
          update([&](Report& report) { report.cases = caseIds(plan).size(); });
          Watcher watcher(*this, stepsOf(plan, options));
          return runPlan(plan, options, make_host, watcher).complete;
        });
}

}  // namespace broadmark
