#include "inspector/jobs/background_bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "broadmark/scenes/simulation.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

void bake(BackgroundBake& job, std::vector<BakeJob> jobs, int threads, const SimulationHost& host) {
  for (BakeJob& pending : jobs) {
    pending.simulation = host(std::move(pending.simulation), [&job] { return job.cancelled(); });
  }
  const auto on_ended = [&](const BakedJob& baked) {
    job.update([&](BakeReport& report) {
      for (BakeReport::Item& item : report.items) {
        if (std::ranges::find(baked.paths, item.path) == baked.paths.end()) continue;
        item.outcome = baked.failure.empty() ? BakeOutcome::baked : BakeOutcome::failed;
        item.failure = baked.failure;
      }
    });
  };
  const auto on_progress = [&](const BatchState& state) {
    job.update([&](BakeReport& report) {
      report.activity = state.running;
      report.seconds_left = state.seconds_left;
      report.fraction =
          static_cast<float>(static_cast<double>(state.done) /
                             static_cast<double>(std::max<std::uint64_t>(state.total, 1)));
    });
    return !job.cancelled();
  };
  bakeAll(std::move(jobs), threads, on_ended, on_progress);
}

void planAndBake(BackgroundBake& job, const BakeOptions& options, const SimulationHost& host) {
  auto plan =
      planBake(options, [&](const fs::path& path, std::uint64_t number, std::uint64_t total) {
        job.update([&](BakeReport& report) {
          report.activity = fmt::format("checking {}", path.filename().string());
          report.fraction = static_cast<float>(number) / static_cast<float>(total);
        });
        return !job.cancelled();
      });
  if (!plan) return;
  prepare(*plan, options.record);
  job.update([&](BakeReport& report) {
    for (const fs::path& path : plan->kept) {
      report.items.push_back({.path = path, .outcome = BakeOutcome::kept});
    }
    for (const BakeJob& pending : plan->pending) {
      for (const fs::path& path : pending.paths) report.items.push_back({.path = path});
    }
  });
  if (!plan->pending.empty()) bake(job, std::move(plan->pending), options.threads, host);
}

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

JobStatus BakeReport::status() const {
  return {.activity = "Baking: " + text() + ".",
          .outcome = text(),
          .is_error = failed() > 0,
          .values = {{"recordings", std::to_string(items.size())},
                     {"done", std::to_string(count(BakeOutcome::baked))},
                     {"kept", std::to_string(count(BakeOutcome::kept))},
                     {"failed", std::to_string(failed())}}};
}

void startBake(BackgroundBake& job, BakeOptions options, SimulationHost host) {
  job.start({}, [&job, options = std::move(options), host = std::move(host)] {
    planAndBake(job, options, host);
    return !job.cancelled();
  });
}

void startBake(BackgroundBake& job, std::unique_ptr<Simulation> simulation, fs::path path,
               const SimulationHost& host) {
  std::vector<BakeJob> jobs(1);
  jobs[0].scene = simulation->scene();
  jobs[0].simulation = std::move(simulation);
  jobs[0].paths = {std::move(path)};
  job.start({}, [&job, jobs = std::move(jobs), host]() mutable {
    requireBakeable(*jobs[0].simulation, jobs[0].paths);
    job.update([&](BakeReport& report) { report.items = {{.path = jobs[0].paths[0]}}; });
    bake(job, std::move(jobs), 1, host);
    return !job.cancelled();
  });
}

}  // namespace broadmark
