// broadmark import: converts files of other programs to a recording.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "broadmark/error.h"
#include "broadmark/recordings/adapted_frames.h"
#include "broadmark/recordings/recording.h"
#include "command_line/option_types.h"
#include "commands/command.h"
#include "run/recordings.h"
#include "sources/make_source.h"
#include "support/interrupt.h"
#include "support/progress.h"
#include "support/words.h"

namespace broadmark::commands::import {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> inputs;
  fs::path output;
  ReadingOptions reading;
  bool quiet = false;
};

/// Output path; without an extension, adds that of a recording that can hold the scene.
fs::path outputFor(const SceneInfo& scene, fs::path path) {
  if (!path.has_extension()) path += recordingExtension(scene);
  requireRecordingName(path);
  return path;
}

int run(const Options& options) {
  const InterruptGuard guard;
  const std::string& first = options.inputs.front();
  if (!importOf(first, options.reading.format.value)) throw notImported(first);
  Source source = fileSource(options.inputs, options.reading);
  const std::string text = importText(source);
  const std::unique_ptr<IndexedFrames> frames =
      adapted(std::move(source.imported), source.reference.reading);
  const SceneInfo& scene = frames->scene();
  const fs::path path = outputFor(scene, options.output);
  RecordingWriter writer(path, scene, {.source = source.reference.path, .import = text});
  if (!options.quiet) fmt::print(stderr, "{}\n", text);
  Progress progress("importing " + scene.name, scene.frames, options.quiet);
  const bool is_complete =
      recordAll(*frames, writer, [&](std::uint32_t frame) { return progress.advance(frame); });
  if (!is_complete) throw Interrupted();
  const std::string hash = writer.finish();
  progress.print(fmt::format("{}: {} {}, {}, hash {}", path.string(), scene.name, scene.object_type,
                             extentText(scene.objects, scene.frames), hash));
  return 0;
}

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  app.add_option("inputs", options->inputs,
                 fmt::format("files, folders or patterns, all of one kind: {}; several files are a "
                             "sequence, in the order of the numbers in their names",
                             importKindsText()))
      ->type_name("IN")
      ->required();
  addPath(app, "-o,--output", "FILE", options->output,
          "recording to write; without an extension: .aabbs if that can hold it, else .broadmark")
      ->required();
  addReadingOptions(app, options->reading);
  addQuiet(app, options->quiet);
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {.name = "import",
          .summary = "Converts meshes, particles or boxes of other programs to a recording.",
          .examples = {"import boxes.csv -o boxes",
                       "import 'frames/cloth_*.ply' -o cloth --elements triangles"},
          .add = add};
}

}  // namespace broadmark::commands::import
