#include "inspector/jobs/background_bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "broadmark/scenes/simulation.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::size_t BakeReport::count(BakeOutcome outcome) const {
  return static_cast<std::size_t>(std::ranges::count(items, outcome, &Item::outcome));
}

std::string BakeReport::text() const {
  std::string text =
      fmt::format("{} baked, {} kept", count(BakeOutcome::baked), count(BakeOutcome::kept));
  if (failed() > 0) text += fmt::format(", {} failed", failed());
  if (const std::size_t left = count(BakeOutcome::waiting); left > 0) {
    text += fmt::format(", {} not finished", left);
  }
  return text;
}

JobStatus BackgroundBake::statusOf(const Report& report) const {
  return {.doing = "Baking: " + report.text() + ".",
          .outcome = report.text(),
          .faulty = report.failed() > 0,
          .values = {{"recordings", std::to_string(report.items.size())},
                     {"done", std::to_string(report.count(BakeOutcome::baked))},
                     {"kept", std::to_string(report.count(BakeOutcome::kept))},
                     {"failed", std::to_string(report.failed())}}};
}

void BackgroundBake::start(BakeOptions options) {
  begin({}, [this, options = std::move(options)] {
    planAndBake(options);
    return !cancelled();
  });
}

void BackgroundBake::start(std::unique_ptr<Simulation> simulation, fs::path path) {
  BakeJob job;
  job.scene = simulation->scene();
  job.simulation = std::move(simulation);
  job.paths = {std::move(path)};
  begin({}, [this, job = std::move(job)]() mutable {
    bakeOne(std::move(job));
    return !cancelled();
  });
}

void BackgroundBake::bakeOne(BakeJob job) {
  requireBakeable(*job.simulation, job.paths);
  update([&](Report& report) { report.items = {{.path = job.paths.front()}}; });
  std::vector<BakeJob> jobs;
  jobs.push_back(std::move(job));
  bake(std::move(jobs), 1);
}

void BackgroundBake::planAndBake(const BakeOptions& options) {
  auto plan =
      planBake(options, [&](const fs::path& path, std::uint64_t number, std::uint64_t total) {
        update([&](Report& report) {
          report.doing = fmt::format("checking {}", path.filename().string());
          report.fraction = static_cast<float>(number) / static_cast<float>(total);
        });
        return !cancelled();
      });
  if (!plan) return;
  prepare(*plan, options.record);
  update([&](Report& report) {
    for (const fs::path& path : plan->kept) {
      report.items.push_back({.path = path, .outcome = BakeOutcome::kept});
    }
    for (const BakeJob& job : plan->pending) {
      for (const fs::path& path : job.paths) report.items.push_back({.path = path});
    }
  });
  if (!plan->pending.empty()) bake(std::move(plan->pending), options.threads);
}

void BackgroundBake::bake(std::vector<BakeJob> jobs, int threads) {
  const auto on_progress = [&](const BatchState& state) {
    update([&](Report& report) {
      report.doing = state.running;
      report.seconds_left = state.seconds_left;
      report.fraction =
          static_cast<float>(static_cast<double>(state.done) /
                             static_cast<double>(std::max<std::uint64_t>(state.total, 1)));
    });
    return !cancelled();
  };
  bakeAll(
      std::move(jobs), threads, [&](const BakedJob& job) { take(job); }, on_progress);
}

void BackgroundBake::take(const BakedJob& job) {
  update([&](Report& report) {
    for (BakeReport::Item& item : report.items) {
      if (std::ranges::find(job.paths, item.path) == job.paths.end()) continue;
      item.outcome = job.failure.empty() ? BakeOutcome::baked : BakeOutcome::failed;
      item.failure = job.failure;
    }
  });
}

}  // namespace broadmark
