// broadmark bake: every combination of scenes, object types and object counts into recordings.
//
// What is already there, complete and made with the same parameters, is kept: a batch that was
// interrupted goes on where it was.

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "bake_plan.h"
#include "batch.h"
#include "interrupt.h"
#include "movie.h"
#include "options.h"
#include "progress.h"
#include "broadmark/error.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

InputError interruption() {
  return InputError("interrupted: finished recordings are kept, and the same call goes on");
}

/// The plan, with progress. Throws InputError when interrupted.
BakePlan makePlan(const BakeOptions& options) {
  std::optional<Progress> shown;  // only when there is something to check
  auto plan =
      planBake(options, [&](const fs::path& path, std::uint64_t number, std::uint64_t total) {
        if (!shown) shown.emplace("checking what is there", total, options.quiet);
        shown->detail(path.string());
        shown->update(number);
        return !InterruptGuard::requested();
      });
  if (!plan) throw interruption();
  return std::move(*plan);
}

int listPlan(const BakePlan& plan) {
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
std::vector<fs::path> performPlan(BakePlan plan, const BakeOptions& options, Tally& tally) {
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
  BakePlan plan = makePlan(options);
  if (options.list_only) return listPlan(plan);
  prepare(plan, options.output);
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
