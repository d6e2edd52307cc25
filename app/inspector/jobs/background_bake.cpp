#include "inspector/jobs/background_bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "broadmark/scenes/simulation.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kGlance{20};

}  // namespace

std::size_t BackgroundBake::Report::count(Outcome outcome) const {
  return static_cast<std::size_t>(std::ranges::count(items, outcome, &Item::outcome));
}

std::string BackgroundBake::Report::text() const {
  std::string text = fmt::format("{} baked, {} kept", count(Outcome::baked), count(Outcome::kept));
  if (failed() > 0) text += fmt::format(", {} failed", failed());
  if (const std::size_t left = count(Outcome::waiting); left > 0) {
    text += fmt::format(", {} not finished", left);
  }
  return text;
}

void BackgroundBake::start(BakeOptions options) {
  task_.begin({}, [this, options = std::move(options)] {
    planAndBake(options);
    return !task_.cancelled();
  });
}

void BackgroundBake::start(std::unique_ptr<Simulation> simulation, fs::path path) {
  BakeJob job;
  job.scene = simulation->scene();
  job.simulation = std::move(simulation);
  job.paths = {std::move(path)};
  task_.begin({}, [this, job = std::move(job)]() mutable {
    bakeOne(std::move(job));
    return !task_.cancelled();
  });
}

void BackgroundBake::bakeOne(BakeJob job) {
  requireBakeable(*job.simulation, job.paths);
  task_.update([&](Report& report) { report.items = {{.path = job.paths.front()}}; });
  std::vector<BakeJob> jobs;
  jobs.push_back(std::move(job));
  bake(std::move(jobs), 1);
}

void BackgroundBake::planAndBake(const BakeOptions& options) {
  auto plan =
      planBake(options, [&](const fs::path& path, std::uint64_t number, std::uint64_t total) {
        task_.update([&](Report& report) {
          report.doing = fmt::format("checking {}", path.filename().string());
          report.fraction = static_cast<float>(number) / static_cast<float>(total);
        });
        return !task_.cancelled();
      });
  if (!plan) return;
  prepare(*plan, options.record);
  task_.update([&](Report& report) {
    for (const fs::path& path : plan->kept) {
      report.items.push_back({.path = path, .outcome = Outcome::kept});
    }
    for (const BakeJob& job : plan->pending) {
      for (const fs::path& path : job.paths) report.items.push_back({.path = path});
    }
  });
  if (!plan->pending.empty()) bake(std::move(plan->pending), options.threads);
}

void BackgroundBake::bake(std::vector<BakeJob> jobs, int threads) {
  BakeBatch batch(std::move(jobs), threads);
  while (!batch.ended()) {
    if (task_.cancelled()) batch.cancel();
    for (const BakedJob& job : batch.await(kGlance)) take(job);
    const BatchState state = batch.state();
    task_.update([&](Report& report) {
      report.doing = state.running;
      report.seconds_left = state.seconds_left;
      report.fraction =
          static_cast<float>(static_cast<double>(state.done) /
                             static_cast<double>(std::max<std::uint64_t>(state.total, 1)));
    });
  }
}

void BackgroundBake::take(const BakedJob& job) {
  task_.update([&](Report& report) {
    for (Item& item : report.items) {
      if (std::ranges::find(job.paths, item.path) == job.paths.end()) continue;
      item.outcome = job.failure.empty() ? Outcome::baked : Outcome::failed;
      item.failure = job.failure;
    }
  });
}

}  // namespace broadmark
