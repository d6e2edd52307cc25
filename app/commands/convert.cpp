// broadmark convert: converts a recording to another format.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "broadmark/error.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/scenes/simulation.h"
#include "command_line/option_types.h"
#include "commands/command.h"
#include "run/recordings.h"
#include "sources/make_source.h"
#include "support/interrupt.h"
#include "support/progress.h"
#include "support/words.h"

namespace broadmark::commands::convert {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path input;
  fs::path output;
  bool quiet = false;
};

/// Origin of the input, according to itself or its sidecar.
RecordingOrigin originOf(const Recording& input, const fs::path& path) {
  RecordingOrigin origin = input.origin();
  if (origin.source.empty()) origin.source = path.filename().string();
  if (origin.scene_parameters.empty()) origin.scene_parameters = bakedParameters(path);
  return origin;
}

/// The scene as the output must hold it. Bodies that may be absent can be present in all frames.
SceneInfo sceneFor(const fs::path& output, SceneInfo scene) {
  if (output.extension() == kAabbsExtension) scene.all_present = true;
  requireHolds(output, scene);
  return scene;
}

void requirePresent(const Frame& frame, const fs::path& output) {
  const auto absent = std::ranges::find_if(frame.boxes, isEmpty);
  if (absent == frame.boxes.end()) return;
  throw InputError(
      fmt::format("{}: body {} is absent in frame {}: {} recordings hold no absent "
                  "bodies, {} ones do",
                  output.string(), absent - frame.boxes.begin(), frame.index, kAabbsExtension,
                  kBroadmarkExtension));
}

int run(const Options& options) {
  requireRecordingName(options.output);
  const auto input = openRecordingFile(options.input);
  if (fs::weakly_canonical(options.input) == fs::weakly_canonical(options.output)) {
    throw InputError(
        fmt::format("{}: is the input recording: choose another name", options.output.string()));
  }
  const SceneInfo scene = sceneFor(options.output, input->scene());
  RecordingWriter writer(options.output, scene, originOf(*input, options.input));
  const InterruptGuard guard;
  Progress progress("converting " + options.input.string(), scene.frames, options.quiet);
  const bool is_complete = recordAll(
      *input,
      [&](const Frame& frame) {
        if (scene.all_present) requirePresent(frame, options.output);
        writer.write(frame);
      },
      [&](std::uint32_t frame) { return progress.advance(frame); });
  if (!is_complete) throw Interrupted();
  const std::string hash = writer.finish();
  progress.print(fmt::format("{}: {}, {} (of {}), hash {}", options.output.string(),
                             extentText(scene.objects, scene.frames),
                             counted(fs::file_size(options.output), "byte"), input->bytes(), hash));
  return 0;
}

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  app.add_option("input", options->input, "one of the " + recordingKindsText())
      ->type_name("IN")
      ->required();
  app.add_option("output", options->output,
                 fmt::format("recording to write, with a name that ends in {}",
                             fmt::join(boxRecordingExtensions(), " or ")))
      ->type_name("OUT")
      ->required();
  addQuiet(app, options->quiet);
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {.name = "convert",
          .summary = "Converts a recording to another format.",
          .examples = {"convert city.broadmark city.aabbs",
                       "convert recording.aabbs smaller.broadmark"},
          .add = add};
}

}  // namespace broadmark::commands::convert
