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

/// The whole matrix, each recording once.
std::vector<BakeJob> makeJobs(const BakeOptions& options) {
  std::vector<std::string> scenes = options.scenes;
  scenes.insert(scenes.end(), options.parameter_files.begin(), options.parameter_files.end());
  if (scenes.empty()) {
    for (const SceneListing& scene : builtinScenes()) scenes.push_back(scene.id);
  }
  std::vector<BakeJob> jobs;
  std::set<fs::path> paths;
  for (auto& simulation : makeSimulations(scenes, options.scene, options.parameters)) {
    BakeJob job{.simulation = {}, .scene = simulation->scene(), .path = {}};
    job.simulation = std::move(simulation);
    job.path = recordingPath(options.output, job.scene);
    if (paths.insert(job.path).second) jobs.push_back(std::move(job));
  }
  requireKnownParameters(options, jobs);
  return jobs;
}

/// A batch before it begins.
struct Plan {
  std::vector<BakeJob> pending;
  std::vector<BakeJob> kept;

  [[nodiscard]] std::uint64_t bytes() const {
    std::uint64_t sum = 0;
    for (const BakeJob& job : pending) sum += recordingBytes(job.scene);
    return sum;
  }
};

Plan makePlan(std::vector<BakeJob> jobs, const BakeOptions& options) {
  Plan plan;
  const auto exists = [](const BakeJob& job) { return fs::exists(job.path); };
  const auto there = static_cast<std::uint64_t>(std::ranges::count_if(jobs, exists));
  Progress progress("checking what is there", there, options.quiet || options.force || there == 0);
  std::uint64_t checked = 0;
  for (BakeJob& job : jobs) {
    if (InterruptGuard::requested()) throw interruption();
    const bool check = !options.force && exists(job);
    if (check) {
      progress.detail(job.path.string());
      progress.update(++checked);
    }
    const bool kept = check && isBaked(job.path, *job.simulation);
    (kept ? plan.kept : plan.pending).push_back(std::move(job));
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
  const std::uint64_t needed = plan.bytes() + kSidecarBytes * plan.pending.size();
  if (unknown || needed <= free) return;
  throw InputError(
      fmt::format("{}: not enough room: {} recordings take {} bytes, but only {} are free",
                  output.string(), plan.pending.size(), needed, free));
}

/// Fails now rather than after hours: when a file cannot be written.
void requireWritable(const Plan& plan) {
  for (const BakeJob& job : plan.pending) {
    makeDirectory(job.path.parent_path());
    const AtomicFile probe(job.path);
  }
}

int listPlan(const Plan& plan) {
  const auto print = [](const char* what, const BakeJob& job) {
    fmt::print("{}  {:>14}  {}\n", what, recordingBytes(job.scene), job.path.string());
  };
  for (const BakeJob& job : plan.kept) print("kept ", job);
  for (const BakeJob& job : plan.pending) print("bake ", job);
  fmt::print("{} recordings: {} to bake ({} bytes), {} kept\n",
             plan.kept.size() + plan.pending.size(), plan.pending.size(), plan.bytes(),
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
  std::vector<fs::path> whole;
  for (const BakeJob& job : plan.kept) {
    fmt::print("kept   {}\n", job.path.string());
    whole.push_back(job.path);
  }
  std::fflush(stdout);
  tally.kept = plan.kept.size();
  tally.unfinished = plan.pending.size();
  if (plan.pending.empty()) return whole;

  BakeBatch batch(std::move(plan.pending), options.threads);
  Progress progress(fmt::format("baking {} recordings", tally.unfinished), batch.state().total,
                    options.quiet);
  while (!batch.ended()) {
    constexpr std::chrono::milliseconds kGlance{50};
    for (const BakedJob& job : batch.await(kGlance)) {
      --tally.unfinished;
      if (job.failure.empty()) {
        ++tally.baked;
        tally.bytes += fs::file_size(job.path);
        progress.print("baked  " + job.path.string());
        whole.push_back(job.path);
      } else {
        ++tally.failed;
        progress.complain("broadmark: " + job.failure);
      }
    }
    const BatchState state = batch.state();
    progress.detail(fmt::format("({} left), now {}", tally.unfinished, state.running));
    progress.update(state.done, state.seconds_left);
  }
  return whole;
}

/// Draws the movies. False when interrupted.
bool makeMovies(MovieMaker& maker, std::vector<fs::path> recordings, bool quiet) {
  std::ranges::sort(recordings);
  std::uint64_t total = 0;
  for (const fs::path& path : recordings) total += maker.pictures(RecordingReader(path).scene());
  Progress progress(fmt::format("drawing {} movies", recordings.size()), total, quiet);
  std::uint64_t done = 0;
  for (const fs::path& path : recordings) {
    const std::uint32_t pictures = maker.pictures(RecordingReader(path).scene());
    progress.detail(path.stem().string());
    const fs::path folder = maker.make(path, [&](std::uint32_t picture) {
      progress.update(done + picture);
      return !InterruptGuard::requested();
    });
    if (folder.empty()) return false;
    progress.print("movie  " + folder.string());
    progress.update(done += pictures);
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
