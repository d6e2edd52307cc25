// broadmark bake: records every combination of scenes, object types and object counts.
//
// Existing complete recordings with the same parameters are kept, so that an interrupted batch can
// be resumed.

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
#include "sources/make_source.h"
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
  double hard_limit_seconds = 60;
  bool list_only = false;
  bool quiet = false;
};

Interrupted interruption() {
  return Interrupted("finished recordings are kept; rerun the same command to resume");
}

/// Makes the plan and shows progress. Throws Interrupted.
BakePlan makeBakePlan(const Options& options) {
  std::optional<Progress> progress;  // only if there is something to check
  auto plan =
      planBake(options.bake, [&](const fs::path& path, std::uint64_t number, std::uint64_t total) {
        if (!progress) progress.emplace("checking existing recordings", total, options.quiet);
        progress->detail(path.string());
        return progress->advance(number);
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
    for (const fs::path& path : job.paths) print("bake ", minBytes(path, job.scene), path);
  }
  const bool exact =
      std::ranges::all_of(plan.pending, [](const BakeJob& job) { return fitsAabbs(job.scene); });
  fmt::print("{}: {} to bake ({}{}), {} kept\n",
             counted(plan.kept.size() + plan.recordings(), "recording"), plan.recordings(),
             exact ? "" : "at least ", counted(plan.bytes(), "byte"), plan.kept.size());
  return 0;
}

/// Numbers of recordings by outcome.
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

/// Bakes the pending recordings and prints each one when finished. Returns the complete ones.
std::vector<fs::path> executePlan(BakePlan plan, const Options& options, Tally& tally) {
  std::vector<fs::path> complete = plan.kept;
  for (const fs::path& path : complete) fmt::print("kept   {}\n", path.string());
  std::fflush(stdout);
  tally.kept = plan.kept.size();
  tally.unfinished = plan.recordings();
  if (plan.pending.empty()) return complete;

  std::uint64_t work = 0;
  for (const BakeJob& job : plan.pending) work += job.work();
  Progress progress(fmt::format("baking {}", counted(tally.unfinished, "recording")), work,
                    options.quiet);
  const auto on_finished = [&](const BakedJob& job) {
    tally.unfinished -= job.paths.size();
    if (!job.failure.empty()) {
      tally.failed += job.paths.size();
      progress.printError("broadmark: " + job.failure);
      return;
    }
    for (const std::string& line : job.escapes) {
      progress.printError(fmt::format("{}: {}", job.paths.front().string(), line));
    }
    for (const fs::path& path : job.paths) {
      ++tally.baked;
      tally.bytes += fs::file_size(path);
      progress.print("baked  " + path.string());
      complete.push_back(path);
    }
  };
  const auto on_progress = [&](const BatchState& state) {
    progress.detail(fmt::format("({} left), now {}", tally.unfinished, state.running));
    progress.update(state.done, state.seconds_left);
    return true;
  };
  bakeAll(std::move(plan.pending), options.bake.threads, on_finished, on_progress);
  return complete;
}

int run(const Options& options) {
  if (!options.movie.directory.empty()) requirePart(parts::kRenderer, "--movie");
  addEnginesOf(options.bake.plugins, options.hard_limit_seconds);
  const InterruptGuard guard;
  const auto start = std::chrono::steady_clock::now();
  BakePlan plan = makeBakePlan(options);
  if (options.list_only) return listPlan(plan);
  prepare(plan, options.bake.record);
  std::unique_ptr<OffscreenContext> context;
  if (!options.movie.directory.empty()) context = prepareMovies(options.movie);
  Tally tally;
  const std::vector<fs::path> complete = executePlan(std::move(plan), options, tally);
  tally.print(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  if (InterruptGuard::requested()) throw interruption();
  if (context && !makeMovies(*context, options.movie, complete, options.quiet))
    throw interruption();
  return tally.failed == 0 ? exit_status::success : exit_status::bad_input;
}

/// Adds the options for scenes, built-in or in files.
void addScenes(CLI::App& app, Options& options) {
  const auto append = [&](const std::vector<std::string>& names) {
    auto& scenes = options.bake.sources;
    scenes.insert(scenes.end(), names.begin(), names.end());
  };
  CLI::Option* scenes =
      addList(app, "--scenes", "A[,B...]", append, {}, "built-in scenes (default: all)");
  suggestValues(scenes, sceneIds());
  app.add_option_function<std::vector<std::string>>(
         "--parameters", append,
         "bake the scene described by this file: scene parameters, the .json beside a "
         "recording, or an authored scene (.json); other options override it (repeatable)")
      ->type_name("FILE")
      ->allow_extra_args(false);
}

void addMovie(CLI::App& app, MovieOptions& movie) {
  constexpr long long kMaxEvery = 1'000'000;
  const HelpGroup group(app, "Pictures");
  CLI::Option* directory =
      addPath(app, "--movie", "DIR", movie.directory,
              "draw each recording as numbered pictures, in a subfolder of this folder named "
              "after it");
  CLI::Option* every = addInteger(app, "--movie-every", "K", movie.every, 1, kMaxEvery,
                                  "frames between successive pictures");
  hideWithout(parts::kRenderer, {directory, every->needs(directory)});
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
          "folder for the recordings, with a subfolder for each format, such as "
          "Recordings_AABBs/")
      ->required();
  bake.threads = allCores();
  addValue(
      app, "--threads", "T",
      [&bake](const std::string& text) { bake.threads = parseThreadCount(text); }, {},
      "recordings baked at the same time (default: all cores); does not affect their content");
  addPositive(app, "--hard-limit", "SECONDS", options->hard_limit_seconds,
              "limit on a frame of a plug-in's engine");
  addMovie(app, options->movie);
  app.add_flag("--list", options->list_only,
               "print what would be baked or kept, with sizes; bake nothing");
  app.add_flag("--force", bake.force,
               "bake existing recordings again (default: complete recordings are kept)");
  addQuiet(app, options->quiet);
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {.name = "bake",
          .summary = "Simulates scenes into recordings, in batches.",
          .examples = {"bake --scenes freefall,brownian --objects 1000,8000 --output recordings",
                       "bake --list --objects 2000 --frames 60 --output recordings"},
          .add = add};
}

}  // namespace broadmark::commands::bake
