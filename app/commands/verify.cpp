// broadmark verify: reads recordings through, and prints faults and statistics.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "broadmark/error.h"
#include "broadmark/recording.h"
#include "broadmark/scene_statistics.h"
#include "broadmark/scenes/simulation.h"
#include "broadmark/swept_frames.h"
#include "commands/command.h"
#include "exit_status.h"
#include "interrupt.h"
#include "option_types.h"
#include "output.h"
#include "progress.h"
#include "recordings.h"
#include "sources/make_source.h"
#include "table.h"
#include "words.h"

namespace broadmark::commands::verify {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<fs::path> files;
  ReadingOptions reading;
  bool describe = false;
  fs::path json;  ///< "": none
  bool quiet = false;
};

constexpr const char* kNothing = "–";

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.1f} %", 100 * *share) : kNothing;
}

std::vector<std::string> cells(std::string frames, const RangeStatistics& range) {
  const std::optional<double> size_ratio = range.sizeRatio();
  return {"",
          std::move(frames),
          fmt::format("{:.4g}", range.density),
          fmt::format("{:.4g}", range.pairs_per_body),
          percent(range.moving_share),
          fmt::format("{:.4g}", range.min_extent),
          fmt::format("{:.4g}", range.median_extent),
          fmt::format("{:.4g}", range.max_extent),
          size_ratio ? fmt::format("{:.4g}", *size_ratio) : kNothing,
          fmt::format("{}", range.max_outside)};
}

std::string formatDescription(const SceneDescription& description) {
  std::vector<std::vector<std::string>> rows = {{"", "frames", "density", "pairs/body", "moving",
                                                 "smallest", "median", "largest", "ratio",
                                                 "outside"}};
  const auto frames = [](const RangeStatistics& range) {
    return range.first == range.last ? fmt::format("{}", range.first)
                                     : fmt::format("{}–{}", range.first, range.last);
  };
  rows.push_back(cells("initial", description.initial));
  for (const RangeStatistics& part : description.parts) rows.push_back(cells(frames(part), part));
  if (description.overall) rows.push_back(cells("all", *description.overall));
  return alignColumns(rows, std::vector<bool>(rows.front().size(), true));
}

/// Reads every frame, and describes the scene if wanted. Nothing when interrupted. Throws
/// InputError at the first fault.
std::optional<SceneDescription> readThrough(IndexedFrames& recording, bool describe_it,
                                            const FrameProgress& progress) {
  if (describe_it) return describe(recording, 10, progress);
  for (std::optional<Frame> frame = recording.rewind(); frame; frame = recording.next()) {
    if (!progress(frame->index)) return std::nullopt;
  }
  return SceneDescription{};
}

/// The file, to be read as the options say. Throws InputError.
Source sourceOf(const fs::path& file, const Options& options) {
  const auto import = importOf(file);
  std::vector<PlanEntry> entries(1);
  Source& source = entries.front().source;
  source = import ? importedSource({file}, *import, options.reading) : recordingSource(file);
  if (options.reading.swept) sweepBoxes(source);
  requireReadingUsed(options.reading, entries);
  return std::move(source);
}

/// Checks one recording and prints what it is. Nothing when interrupted. Throws InputError.
std::optional<DescribedRecording> verifyOne(const fs::path& file, const Options& options) {
  Source source = sourceOf(file, options);
  const auto opened = openRecording(source, {}, {}, options.quiet);
  if (!opened) return std::nullopt;
  IndexedFrames& recording = *opened;
  const std::string& hash = source.reference.hash;
  const SceneInfo& scene = recording.scene();
  const bool slow = options.describe || recordingBytes(scene) > (1U << 28);
  Progress progress("verifying " + file.string(), scene.frames, !slow || options.quiet);
  const auto description = readThrough(recording, options.describe, [&](std::uint32_t frame) {
    progress.update(frame);
    return !InterruptGuard::requested();
  });
  if (!description) return std::nullopt;
  std::optional<std::string> stated = bakedHash(file);
  if (stated && options.reading.swept) stated = sweptHash(*stated);
  if (stated && *stated != hash) {
    throw InputError(fmt::format("{}: its hash is {}, but {} says {}: changed since it was baked",
                                 file.string(), hash,
                                 fs::path(file).replace_extension(".json").string(), *stated));
  }
  if (!isStandardOutput(options.json)) {
    progress.print(fmt::format("{}: ok: {} {}, {}, hash {}{}", file.string(), scene.name,
                               scene.object_type, extentText(scene.objects, scene.frames), hash,
                               stated ? ", as baked" : ""));
    if (options.describe) progress.print(formatDescription(*description));
  }
  return DescribedRecording{file.string(), hash, scene, *description};
}

int run(const Options& options) {
  if (!options.json.empty()) requireOutput(options.json);
  const InterruptGuard guard;
  int status = exit_status::fine;
  std::vector<DescribedRecording> described;
  for (const auto& file : options.files) {
    try {
      auto one = verifyOne(file, options);
      if (!one) throw Interrupted();
      described.push_back(std::move(*one));
    } catch (const InputError& error) {
      fmt::print(stderr, "broadmark: {}\n", error.what());
      status = exit_status::bad_input;
    }
  }
  if (!options.json.empty()) writeOutput(options.json, formatDescriptions(described));
  return status;
}

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  app.add_option("files", options->files,
                 fmt::format("{}; or what can be imported: {}", recordingKindsText(),
                             importKindsText()))
      ->type_name("FILE")
      ->required();
  CLI::Option* describe =
      app.add_flag("--describe", options->describe,
                   "also print what each is like, over time: density, pairs per body, share of "
                   "moving bodies, sizes (longest edge of a box), most bodies outside the world");
  addPath(app, "--json", "FILE", options->json,
          "write that as JSON, too; '-': to standard output, instead of all else")
      ->needs(describe);
  addReadingOptions(app, options->reading);
  addQuiet(app, options->quiet);
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {
      .name = "verify", .summary = "Checks recordings, also against their sidecars.", .add = add};
}

}  // namespace broadmark::commands::verify
