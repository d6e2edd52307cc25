// Planning is cheap except for existing recordings, which are read completely to verify their hash.

#include "bake/bake_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "request/cases.h"
#include "run/recordings.h"
#include "sources/make_source.h"
#include "support/words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Creates a job for every combination, without duplicates.
std::vector<BakeJob> makeJobs(const BakeOptions& options) {
  std::vector<BakeJob> jobs;
  std::set<std::vector<fs::path>> planned;
  std::vector<std::string> parameters;
  for (const std::string& name : options.sources.empty() ? sceneIds() : options.sources) {
    NamedSource scene(name);
    for (auto& [simulation, swept] : makeSimulations(scene, options.scene, options.parameters)) {
      BakeJob job{.simulation = {}, .scene = simulation->scene(), .paths = {}};
      job.simulation = std::move(simulation);
      job.paths = recordingPaths(options.record, job.scene, swept, options.scene.recorders);
      requireBakeable(*job.simulation, job.paths);
      std::ranges::move(parameterNames(*job.simulation), std::back_inserter(parameters));
      if (planned.insert(job.paths).second) jobs.push_back(std::move(job));
    }
  }
  requireKnownParameters(options.parameters, std::move(parameters));
  return jobs;
}

/// Throws InputError if the recordings do not fit on the disc.
void requireRoom(const BakePlan& plan, const fs::path& output) {
  // A sidecar beside each recording takes whole blocks.
  constexpr std::uint64_t kSidecarBytes = 1 << 13;
  fs::path existing = fs::absolute(output);
  while (!fs::exists(existing) && existing.has_relative_path()) existing = existing.parent_path();
  std::error_code failed;
  const std::uint64_t free = fs::space(existing, failed).available;
  const std::uint64_t needed = plan.bytes() + kSidecarBytes * plan.recordings();
  if (failed || needed <= free) return;
  throw InputError(fmt::format("{}: not enough space: {} would take {} bytes, but only {} are free",
                               output.string(), counted(plan.recordings(), "recording"), needed,
                               free));
}

/// Throws InputError if a recording cannot be written.
void requireWritable(const BakePlan& plan) {
  for (const BakeJob& job : plan.pending) {
    for (const fs::path& path : job.paths) {
      makeDirectory(path.parent_path());
      const AtomicFile probe(path);
    }
  }
}

}  // namespace

std::uint64_t minBytes(const fs::path& path, SceneInfo scene) {
  // The changes between frames are not known yet.
  if (path.extension() == kBroadmarkExtension) scene.frames = 0;
  return recordingBytes(scene);
}

std::size_t BakePlan::recordings() const {
  std::size_t sum = 0;
  for (const BakeJob& job : pending) sum += job.paths.size();
  return sum;
}

std::uint64_t BakePlan::bytes() const {
  std::uint64_t sum = 0;
  for (const BakeJob& job : pending) {
    for (const fs::path& path : job.paths) sum += minBytes(path, job.scene);
  }
  return sum;
}

std::optional<BakePlan> planBake(const BakeOptions& options, const PlanProgress& progress) try {
  std::vector<BakeJob> jobs = makeJobs(options);
  const auto to_check = [&](const fs::path& path) { return !options.force && fs::exists(path); };
  std::uint64_t total = 0;
  for (const BakeJob& job : jobs) {
    total += static_cast<std::uint64_t>(std::ranges::count_if(job.paths, to_check));
  }
  BakePlan plan;
  std::uint64_t number = 0;
  for (BakeJob& job : jobs) {
    std::vector<fs::path> missing;
    for (const fs::path& path : job.paths) {
      if (!to_check(path)) {
        missing.push_back(path);
        continue;
      }
      ++number;
      const auto stopped = [&] { return progress && !progress(path, number, total); };
      if (stopped()) throw Cancelled();
      if (isBaked(path, *job.simulation, stopped)) {
        plan.kept.push_back(path);
        continue;
      }
      if (isIntact(path, stopped)) {
        throw InputError(fmt::format(
            "{}: baked before with other parameters (see its .json): --force replaces it, another "
            "--output keeps it",
            path.string()));
      }
      missing.push_back(path);
    }
    job.paths = std::move(missing);
    if (!job.paths.empty()) plan.pending.push_back(std::move(job));
  }
  return plan;
} catch (const Cancelled&) {
  return {};
}

void prepare(const BakePlan& plan, const fs::path& output) {
  makeDirectory(output);
  requireRoom(plan, output);
  requireWritable(plan);
}

}  // namespace broadmark
