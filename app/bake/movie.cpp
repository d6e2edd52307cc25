// Frames to PNG files: reading, finding the pairs, drawing and compressing, one frame at a time.

#include "bake/movie.h"

#include <fmt/format.h>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/names.h"
#include "run/recordings.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<OffscreenContext> contextFor(const MovieOptions& options) {
  try {
    return makeOffscreenContext(options.picture.gl);
  } catch (const RenderError& error) {
    throw InputError(fmt::format("--movie: {}", error.what()));
  }
}

/// Numbered from 0 without gaps, as video tools expect.
fs::path picturePath(const fs::path& folder, std::uint32_t number) {
  return folder / fmt::format("frame_{:05}.png", number);
}

/// What the movie.json of a finished movie says.
std::string label(Recording& recording, const MovieOptions& options) {
  return fmt::format(
      R"({{"schema": "broadmark-movie/1", "recording": "{}", "every": {}, "size": "{}x{}"}})"
      "\n",
      recording.hash(), options.every, options.picture.width, options.picture.height);
}

bool isMade(const fs::path& folder, const fs::path& label_path, const std::string& label,
            std::uint32_t pictures) {
  if (!fs::exists(label_path) || readTextFile(label_path) != label) return false;
  for (std::uint32_t number = 0; number < pictures; ++number) {
    if (!fs::exists(picturePath(folder, number))) return false;
  }
  return true;
}

/// Removes an older movie: it may have been longer, and its label is about to be wrong.
void removeOlder(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name == "movie.json" || globMatches("frame_*.png", name)) fs::remove(entry.path());
  }
}

}  // namespace

MovieMaker::MovieMaker(MovieOptions options)
    : options_(std::move(options)), context_(contextFor(options_)) {
  makeDirectory(options_.directory);
}

MovieMaker::~MovieMaker() = default;

std::uint32_t MovieMaker::pictures(const SceneInfo& scene) const {
  return scene.frames / options_.every + 1;
}

fs::path MovieMaker::make(const fs::path& path, const PictureProgress& progress) {
  const auto opened = openRecordingFile(path);
  Recording& recording = *opened;
  const SceneInfo& scene = recording.scene();
  fs::path folder = options_.directory / path.stem();
  const fs::path label_path = folder / "movie.json";
  const std::string text = label(recording, options_);
  makeDirectory(folder);
  if (isMade(folder, label_path, text, pictures(scene))) return folder;
  removeOlder(folder);
  for (std::uint32_t number = 0; number < pictures(scene); ++number) {
    const Frame frame = recording.at(number * options_.every);
    const std::vector<Pair> pairs = sweptPairs(frame.boxes, scene.filter);
    const PairRun run = pairs;
    writePng(picturePath(folder, number),
             drawFrame(*context_, scene, frame, {&run, 1}, options_.picture.width,
                       options_.picture.height));
    if (!progress(number)) return {};
  }
  writeTextFile(label_path, text);
  return folder;
}

}  // namespace broadmark
