// broadmark bake: every combination of scenes, object types and object counts as a recording.
//
// Recordings that are there, complete and made with the same parameters, are kept: an interrupted
// batch continues where it was.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "bake/bake_plan.h"
#include "bake/batch.h"
#include "bake/movie.h"
#include "broadmark/error.h"
#include "command_line/option_types.h"
#include "commands/command.h"
#include "request/plugins.h"
#include "support/exit_status.h"
#include "support/interrupt.h"
#include "support/progress.h"
#include "support/words.h"

namespace broadmark::commands::bake {
namespace {

namespace fs = std::filesystem;

struct Options {
  BakeOptions bake;
  MovieOptions movie;
  bool list_only = false;
  bool quiet = false;
};

Interrupted interruption() {
  return Interrupted("finished recordings are kept; the same call continues");
}

/// The plan, with progress. Throws Interrupted.
BakePlan makeBakePlan(const Options& options) {
  std::optional<Progress> shown;  // only when there is something to check
  auto plan =
      planBake(options.bake, [&](const fs::path& path, std::uint64_t number, std::uint64_t total) {
        if (!shown) shown.emplace("checking existing recordings", total, options.quiet);
        shown->detail(path.string());
        return shown->goOn(number);
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
    for (const fs::path& path : job.paths) print("bake ", leastBytes(path, job.scene), path);
  }
  const bool exact =
      std::ranges::all_of(plan.pending, [](const BakeJob& job) { return fitsAabbs(job.scene); });
  fmt::print("{}: {} to bake ({}{}), {} kept\n",
             counted(plan.kept.size() + plan.recordings(), "recording"), plan.recordings(),
             exact ? "" : "at least ", counted(plan.bytes(), "byte"), plan.kept.size());
  return 0;
}

/// How many recordings ended how.
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
    fmt::print("{}; {} written in {:.1f} s\n", text, counted(bytes, "byte"), seconds);
  }
};

/// Bakes what is pending and prints each recording as it ends. Returns those that are whole.
std::vector<fs::path> performPlan(BakePlan plan, const Options& options, Tally& tally) {
  std::vector<fs::path> whole = plan.kept;
  for (const fs::path& path : whole) fmt::print("kept   {}\n", path.string());
  std::fflush(stdout);
  tally.kept = plan.kept.size();
  tally.unfinished = plan.recordings();
  if (plan.pending.empty()) return whole;

  std::uint64_t work = 0;
  for (const BakeJob& job : plan.pending) work += job.work();
  Progress progress(fmt::format("baking {}", counted(tally.unfinished, "recording")), work,
                    options.quiet);
  const auto on_end = [&](const BakedJob& job) {
    tally.unfinished -= job.paths.size();
    if (!job.failure.empty()) {
      tally.failed += job.paths.size();
      progress.complain("broadmark: " + job.failure);
      return;
    }
    for (const fs::path& path : job.paths) {
      ++tally.baked;
      tally.bytes += fs::file_size(path);
      progress.print("baked  " + path.string());
      whole.push_back(path);
    }
  };
  const auto on_progress = [&](const BatchState& state) {
    progress.detail(fmt::format("({} left), now {}", tally.unfinished, state.running));
    progress.update(state.done, state.seconds_left);
    return true;
  };
  bakeAll(std::move(plan.pending), options.bake.threads, on_end, on_progress);
  return whole;
}

int run(const Options& options) {
  if (!options.movie.directory.empty()) requirePart(parts::kRenderer, "--movie");
  addEnginesOf(options.bake.plugins);
  const InterruptGuard guard;
  const auto begin = std::chrono::steady_clock::now();
  BakePlan plan = makeBakePlan(options);
  if (options.list_only) return listPlan(plan);
  prepare(plan, options.bake.record);
  std::unique_ptr<OffscreenContext> drawing;
  if (!options.movie.directory.empty()) drawing = prepareMovies(options.movie);
  Tally tally;
  const std::vector<fs::path> whole = performPlan(std::move(plan), options, tally);
  tally.print(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  if (InterruptGuard::requested()) throw interruption();
  if (drawing && !makeMovies(*drawing, options.movie, whole, options.quiet)) throw interruption();
  return tally.failed == 0 ? exit_status::fine : exit_status::bad_input;
}

/// The scenes, built-in or in files.
void addScenes(CLI::App& app, Options& options) {
  const auto append = [&](const std::vector<std::string>& names) {
    auto& scenes = options.bake.sources;
    scenes.insert(scenes.end(), names.begin(), names.end());
  };
  addList(app, "--scenes", "A[,B...]", append, {}, "built-in scenes (default: all)");
  app.add_option_function<std::vector<std::string>>(
         "--parameters", append,
         "bake the scene that this file of scene parameters, the .json beside a recording, or an "
         "authored scene (.json) describes; other options override it (repeatable)")
      ->type_name("FILE")
      ->allow_extra_args(false);
}

void addMovie(CLI::App& app, MovieOptions& movie) {
  constexpr long long kMaxEvery = 1'000'000;
  CLI::Option* directory =
      addPath(app, "--movie", "DIR", movie.directory,
              "draw each recording into numbered pictures, in a folder of its name in this "
              "directory");
  CLI::Option* every = addInteger(app, "--movie-every", "K", movie.every, 1, kMaxEvery,
                                  "frames from one picture to the next");
  showWith(parts::kRenderer, {directory, every->needs(directory)});
  for (CLI::Option* option : addPictureOptions(app, movie.picture)) option->needs(directory);
}

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  BakeOptions& bake = options->bake;
  addScenes(app, *options);
  addSceneOptions(app, bake.scene);
  addPlugins(app, bake.plugins, "physics engines");
  addRecorders(app, bake.scene.recorders);
  addParameters(app, bake.parameters);
  addPath(app, "--output", "DIR", bake.record,
          "directory for the recordings; they go into folders of their kind in it, such as "
          "Recordings_AABBs/")
      ->required();
  bake.threads = allCores();
  addValue(
      app, "--threads", "T",
      [&bake](const std::string& text) { bake.threads = parseThreadCount(text); }, {},
      "recordings baked at the same time (default: all cores); they do not depend on it");
  addMovie(app, options->movie);
  app.add_flag("--list", options->list_only,
               "print what would be baked or kept, with sizes; bake nothing");
  app.add_flag("--force", bake.force,
               "bake again what is already there (default: complete recordings are kept)");
  addQuiet(app, options->quiet);
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {.name = "bake", .summary = "Simulates scenes into recordings, in batches.", .add = add};
}

}  // namespace broadmark::commands::bake
