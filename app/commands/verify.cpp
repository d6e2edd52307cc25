// broadmark verify: reads complete recordings, and prints faults and statistics.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <span>

#include "broadmark/analysis/scene_statistics.h"
#include "broadmark/error.h"
#include "broadmark/recordings/adapted_frames.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/scenes/simulation.h"
#include "command_line/option_types.h"
#include "commands/command.h"
#include "run/recordings.h"
#include "sources/make_source.h"
#include "support/exit_status.h"
#include "support/interrupt.h"
#include "support/output.h"
#include "support/progress.h"
#include "support/table.h"
#include "support/words.h"

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

constexpr const char* kNoValue = "–";

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.1f} %", 100 * *share) : kNoValue;
}

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : kNoValue;
}

using Cells = std::vector<std::string>;

constexpr const char* kBoxHeadings[] = {"density", "pairs/body", "moving", "smallest",
                                        "median",  "largest",    "ratio",  "outside"};
Cells boxCells(const RangeStatistics& range) {
  return {number(range.density),       number(range.pairs_per_body),
          percent(range.moving_share), number(range.min_extent),
          number(range.median_extent), number(range.max_extent),
          number(range.sizeRatio()),   fmt::format("{}", range.max_outside)};
}

/// For worlds in which bodies appear or disappear.
constexpr const char* kPopulationHeadings[] = {"min bodies", "mean",   "max",
                                               "appear",     "vanish", "change"};
Cells populationCells(const RangeStatistics& range) {
  const auto change = [&](double Changes::* member) {
    return range.changes ? number((*range.changes).*member) : kNoValue;
  };
  return {number(range.min_bodies),   number(range.mean_bodies),  number(range.max_bodies),
          change(&Changes::appeared), change(&Changes::vanished), change(&Changes::changed)};
}

/// Formats rows with columns aligned to the right.
std::string rightAligned(const std::vector<Cells>& rows) {
  return alignColumns(rows, std::vector<bool>(rows.front().size(), true));
}

/// Table of the layers: numbers of bodies, and of pairs between two colliding layers.
std::string layerTable(const FilterStatistics& filter) {
  std::vector<Cells> rows = {{"", "layer", "bodies"}};
  for (const auto& [layer, bodies] : filter.layers) {
    rows.front().push_back(fmt::format("with {}", layer));
    rows.push_back({"", fmt::format("{}", layer), number(bodies)});
    for (const auto& [other, others] : filter.layers) {
      const auto pair = std::ranges::find_if(filter.layer_pairs, [&](const auto& entry) {
        return entry.a == std::min(layer, other) && entry.b == std::max(layer, other);
      });
      rows.back().push_back(pair == filter.layer_pairs.end() ? kNoValue : number(pair->pairs));
    }
  }
  return rightAligned(rows);
}

std::string formatFilter(const FilterStatistics& filter) {
  std::string text;
  if (filter.layers.size() > 1 || filter.layer_pairs.empty()) text += layerTable(filter);
  if (filter.worlds > 1) {
    text += fmt::format("  {} worlds, of at most {}\n", filter.worlds,
                        counted(filter.largest_world, "body", "bodies"));
  }
  if (filter.tagged > 0) {
    text += fmt::format("  {} with tags\n", counted(filter.tagged, "body", "bodies"));
  }
  if (filter.changed) {
    text +=
        fmt::format("  bodies with a new layer or new tags: {} a frame\n", number(filter.changed));
  }
  return text;
}

/// Table with a row for each part of the scene.
std::string rangeTable(std::span<const char* const> headings,
                       Cells (*cells)(const RangeStatistics&),
                       const SceneDescription& description) {
  std::vector<Cells> rows = {{"", "frames"}};
  std::ranges::copy(headings, std::back_inserter(rows.front()));
  const auto add = [&](std::string frames, const RangeStatistics& range) {
    rows.push_back({"", std::move(frames)});
    std::ranges::copy(cells(range), std::back_inserter(rows.back()));
  };
  add("initial", description.initial);
  for (const RangeStatistics& part : description.parts) {
    add(part.first == part.last ? fmt::format("{}", part.first)
                                : fmt::format("{}–{}", part.first, part.last),
        part);
  }
  if (description.overall) add("all", *description.overall);
  return rightAligned(rows);
}

std::string formatDescription(const SceneInfo& scene, const SceneDescription& description) {
  std::string text = rangeTable(kBoxHeadings, boxCells, description);
  if (!scene.all_present)
    text += "\n" + rangeTable(kPopulationHeadings, populationCells, description);
  if (description.filter) text += "\n" + formatFilter(*description.filter);
  return text;
}

/// Reads every frame, and optionally describes the scene. Returns nothing when interrupted. Throws
/// InputError at the first fault.
std::optional<SceneDescription> readFrames(IndexedFrames& recording, bool describe_it,
                                           const FrameProgress& progress) {
  if (describe_it) return describe(recording, 10, progress);
  for (std::optional<Frame> frame = recording.rewind(); frame; frame = recording.next()) {
    if (!progress(frame->index)) return std::nullopt;
  }
  return SceneDescription{};
}

/// Checks a recording and prints its description. Returns nothing when interrupted. Throws
/// InputError.
std::optional<DescribedRecording> verifyRecording(const fs::path& file, const Options& options) {
  Source source = fileSource({file.string()}, options.reading);
  const auto opened = openForCommand(source, options.quiet);
  IndexedFrames& recording = *opened;
  const std::string& hash = source.reference.hash;
  const SceneInfo& scene = recording.scene();
  const bool is_slow = options.describe || recordingBytes(scene) > (1U << 28);
  Progress progress("verifying " + file.string(), scene.frames, !is_slow || options.quiet);
  const auto description = readFrames(recording, options.describe,
                                      [&](std::uint32_t frame) { return progress.advance(frame); });
  if (!description) return std::nullopt;
  std::optional<std::string> stated = bakedHash(file);
  if (stated) stated = adaptedHash(*stated, source.reference.reading);
  if (stated && *stated != hash) {
    throw InputError(fmt::format("{}: its hash is {}, but {} says {}: changed since it was baked",
                                 file.string(), hash,
                                 fs::path(file).replace_extension(".json").string(), *stated));
  }
  if (!isStandardOutput(options.json)) {
    progress.print(fmt::format("{}: ok: {} {}, {}, hash {}{}", file.string(), scene.name,
                               scene.object_type, extentText(scene.objects, scene.frames), hash,
                               stated ? ", as baked" : ""));
    const auto* stored = dynamic_cast<const Recording*>(opened.get());
    if (stored != nullptr && !stored->origin().import.empty()) {
      progress.print("  imported from " + stored->origin().import);
    }
    if (options.describe) progress.print(formatDescription(scene, *description));
  }
  return DescribedRecording{file.string(), hash, scene, *description};
}

int run(const Options& options) {
  if (!options.json.empty()) requireOutput(options.json);
  const InterruptGuard guard;
  int status = exit_status::success;
  std::vector<DescribedRecording> described;
  for (const auto& file : options.files) {
    try {
      auto recording = verifyRecording(file, options);
      if (!recording) throw Interrupted();
      described.push_back(std::move(*recording));
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
  app.add_option(
         "files", options->files,
         fmt::format("{}; or importable files: {}", recordingKindsText(), importKindsText()))
      ->type_name("FILE")
      ->required();
  CLI::Option* describe = app.add_flag(
      "--describe", options->describe,
      "also print statistics over time: density, pairs per body, share of moving bodies, sizes "
      "(longest edge of a box), maximum number of bodies outside the world; if bodies come and go, "
      "how many are present, and how many appear, vanish and change per frame; if pairs are "
      "filtered, bodies by layer, and pairs by colliding layers ('–': no collisions)");
  addPath(app, "--json", "FILE", options->json,
          "also write the statistics as JSON; '-': to standard output, instead of all other output")
      ->needs(describe);
  addReadingOptions(app, options->reading);
  addQuiet(app, options->quiet);
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {.name = "verify",
          .summary = "Checks recordings, also against their sidecars.",
          .examples = {"verify recording.aabbs", "verify --describe boxes.csv"},
          .add = add};
}

}  // namespace broadmark::commands::verify
