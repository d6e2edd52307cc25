// broadmark bake: every combination of scenes, object types and object counts into recordings.
//
// What is already there, complete and made with the same parameters, is kept: a batch that was
// interrupted goes on where it was.

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/batch.h"
#include "app/cases.h"
#include "app/interrupt.h"
#include "app/movie.h"
#include "app/options.h"
#include "app/progress.h"
#include "app/recordings.h"
#include "broadmark/atomic_file.h"
#include "broadmark/error.h"
#include "broadmark/names.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

InputError interruption() {
  return InputError("interrupted: finished recordings are kept, and the same call goes on");
}

/// A --param that no scene has is an error.
void requireKnownParameters(const BakeOptions& options, const std::vector<BakeJob>& jobs) {
  std::vector<std::string> known;
  for (const BakeJob& job : jobs) {
    std::ranges::move(parameterNames(*job.simulation), std::back_inserter(known));
  }
  for (const auto& [name, value] : options.parameters) {
    if (std::ranges::find(known, name) == known.end()) {
      throw InputError("--param: " + unknownName("parameter", name, known));
    }
  }
}

/// The whole matrix, each combination once.
std::vector<BakeJob> makeJobs(const BakeOptions& options) {
  std::vector<std::string> scenes = options.scenes;
  scenes.insert(scenes.end(), options.parameter_files.begin(), options.parameter_files.end());
  if (scenes.empty()) {
    for (const SceneListing& scene : builtinScenes()) scenes.push_back(scene.id);
  }
  std::vector<BakeJob> jobs;
  std::set<std::vector<fs::path>> taken;
  for (auto& simulation : makeSimulations(scenes, options.scene, options.parameters)) {
    BakeJob job{.simulation = {}, .scene = simulation->scene(), .paths = {}};
    job.simulation = std::move(simulation);
    job.paths = recordingPaths(options.output, job.scene, options.scene.recorders);
    requireApart(*job.simulation, job.paths);
    if (taken.insert(job.paths).second) jobs.push_back(std::move(job));
  }
  requireKnownParameters(options, jobs);
  return jobs;
}

/// A batch before it begins.
struct Plan {
  std::vector<BakeJob> pending;  ///< only with the recordings that are to be written
  std::vector<fs::path> kept;

  /// Recordings to be written.
  [[nodiscard]] std::size_t recordings() const {
    std::size_t sum = 0;
    for (const BakeJob& job : pending) sum += job.paths.size();
    return sum;
  }
  [[nodiscard]] std::uint64_t bytes() const {
    std::uint64_t sum = 0;
    for (const BakeJob& job : pending) sum += job.paths.size() * recordingBytes(job.scene);
    return sum;
  }
};

Plan makePlan(std::vector<BakeJob> jobs, const BakeOptions& options) {
  Plan plan;
  std::uint64_t there = 0;
  for (const BakeJob& job : jobs) {
    there += static_cast<std::uint64_t>(
        std::ranges::count_if(job.paths, [](const fs::path& path) { return fs::exists(path); }));
  }
  Progress progress("checking what is there", there, options.quiet || options.force || there == 0);
  std::uint64_t checked = 0;
  for (BakeJob& job : jobs) {
    std::erase_if(job.paths, [&](const fs::path& path) {
      if (InterruptGuard::requested()) throw interruption();
      if (options.force || !fs::exists(path)) return false;
      progress.detail(path.string());
      progress.update(++checked);
      const bool whole = isBaked(path, *job.simulation);
      if (whole) plan.kept.push_back(path);
      return whole;
    });
    if (!job.paths.empty()) plan.pending.push_back(std::move(job));
  }
  return plan;
}

/// Fails now rather than after hours: when what is missing would not fit on the disc.
void requireRoom(const Plan& plan, const fs::path& output) {
  // Beside each recording its sidecar, in whole blocks.
  constexpr std::uint64_t kSidecarBytes = 1 << 13;
  fs::path there = fs::absolute(output);
  while (!fs::exists(there) && there.has_relative_path()) there = there.parent_path();
  std::error_code unknown;
  const std::uint64_t free = fs::space(there, unknown).available;
  const std::uint64_t needed = plan.bytes() + kSidecarBytes * plan.recordings();
  if (unknown || needed <= free) return;
  throw InputError(
      fmt::format("{}: not enough room: {} recordings take {} bytes, but only {} are free",
                  output.string(), plan.recordings(), needed, free));
}

/// Fails now rather than after hours: when a file cannot be written.
void requireWritable(const Plan& plan) {
  for (const BakeJob& job : plan.pending) {
    for (const fs::path& path : job.paths) {
      makeDirectory(path.parent_path());
      const AtomicFile probe(path);
    }
  }
}

int listPlan(const Plan& plan) {
  const auto print = [](const char* what, std::uint64_t bytes, const fs::path& path) {
    fmt::print("{}  {:>14}  {}\n", what, bytes, path.string());
  };
  for (const fs::path& path : plan.kept) print("kept ", fs::file_size(path), path);
  for (const BakeJob& job : plan.pending) {
    for (const fs::path& path : job.paths) print("bake ", recordingBytes(job.scene), path);
  }
  fmt::print("{} recordings: {} to bake ({} bytes), {} kept\n",
             plan.kept.size() + plan.recordings(), plan.recordings(), plan.bytes(),
             plan.kept.size());
  return 0;
}

/// What a batch has come to.
struct Tally {
  std::size_t kept = 0;
  std::size_t baked = 0;
  std::size_t failed = 0;
  std::size_t unfinished = 0;
  std::uint64_t bytes = 0;

  void print(double seconds) const {
    std::string text = fmt::format("{} baked, {} kept", baked, kept);
    if (failed > 0) text += fmt::format(", {} failed", failed);
    if (unfinished > 0) text += fmt::format(", {} not finished", unfinished);
    fmt::print("{}; {} bytes written in {:.1f} s\n", text, bytes, seconds);
  }
};

/// Bakes all that is pending and tells of each recording as it ends. Returns those that are whole.
std::vector<fs::path> performPlan(Plan plan, const BakeOptions& options, Tally& tally) {
  std::vector<fs::path> whole = plan.kept;
  for (const fs::path& path : whole) fmt::print("kept   {}\n", path.string());
  std::fflush(stdout);
  tally.kept = plan.kept.size();
  tally.unfinished = plan.recordings();
  if (plan.pending.empty()) return whole;

  BakeBatch batch(std::move(plan.pending), options.threads);
  Progress progress(fmt::format("baking {} recordings", tally.unfinished), batch.state().total,
                    options.quiet);
  while (!batch.ended()) {
    constexpr std::chrono::milliseconds kGlance{50};
    for (const BakedJob& job : batch.await(kGlance)) {
      tally.unfinished -= job.paths.size();
      if (!job.failure.empty()) {
        tally.failed += job.paths.size();
        progress.complain("broadmark: " + job.failure);
        continue;
      }
      for (const fs::path& path : job.paths) {
        ++tally.baked;
        tally.bytes += fs::file_size(path);
        progress.print("baked  " + path.string());
        whole.push_back(path);
      }
    }
    const BatchState state = batch.state();
    progress.detail(fmt::format("({} left), now {}", tally.unfinished, state.running));
    progress.update(state.done, state.seconds_left);
  }
  return whole;
}

/// Draws the movies, one of recordings that differ in nothing but their kind. False when
/// interrupted.
bool makeMovies(MovieMaker& maker, std::vector<fs::path> recordings, bool quiet) {
  std::ranges::sort(recordings);
  std::set<fs::path> names;
  std::erase_if(recordings,
                [&](const fs::path& path) { return !names.insert(path.stem()).second; });
  const auto pictures = [&](const fs::path& path) {
    return maker.pictures(openRecordingFile(path)->scene());
  };
  std::uint64_t total = 0;
  for (const fs::path& path : recordings) total += pictures(path);
  Progress progress(fmt::format("drawing {} movies", recordings.size()), total, quiet);
  std::uint64_t done = 0;
  for (const fs::path& path : recordings) {
    progress.detail(path.stem().string());
    const fs::path folder = maker.make(path, [&](std::uint32_t picture) {
      progress.update(done + picture);
      return !InterruptGuard::requested();
    });
    if (folder.empty()) return false;
    progress.print("movie  " + folder.string());
    progress.update(done += pictures(path));
  }
  return true;
}

}  // namespace

int runBake(const BakeOptions& options) {
  const InterruptGuard guard;
  const auto begin = std::chrono::steady_clock::now();
  Plan plan = makePlan(makeJobs(options), options);
  if (options.list_only) return listPlan(plan);
  requireRoom(plan, options.output);
  makeDirectory(options.output);
  requireWritable(plan);
  std::optional<MovieMaker> movie_maker;
  if (options.movie) movie_maker.emplace(*options.movie);
  Tally tally;
  const std::vector<fs::path> whole = performPlan(std::move(plan), options, tally);
  tally.print(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  if (tally.unfinished > 0) throw interruption();
  if (movie_maker && !makeMovies(*movie_maker, whole, options.quiet)) throw interruption();
  return tally.failed == 0 ? 0 : 2;
}

}  // namespace broadmark
