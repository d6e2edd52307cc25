// Draws frames to PNG files: reads, finds pairs, draws and compresses one frame at a time.

#include "bake/movie.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/names.h"
#include "run/recordings.h"
#include "support/progress.h"
#include "support/words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

std::uint32_t pictureCount(const Recording& recording, const MovieOptions& options) {
  return recording.scene().frames / options.every + 1;
}

/// Numbered from 0 without gaps, as video tools expect.
fs::path picturePath(const fs::path& folder, std::uint32_t number) {
  return folder / fmt::format("frame_{:05}.png", number);
}

/// Content of a finished movie's movie.json.
std::string label(Recording& recording, const MovieOptions& options) {
  return fmt::format(
      R"({{"schema": "broadmark-movie/1", "recording": "{}", "every": {}, "size": "{}x{}"}})"
      "\n",
      recording.hash(), options.every, options.picture.width, options.picture.height);
}

bool isComplete(const fs::path& folder, const fs::path& label_path, const std::string& label,
                std::uint32_t pictures) {
  if (!fs::exists(label_path) || readTextFile(label_path) != label) return false;
  for (std::uint32_t number = 0; number < pictures; ++number) {
    if (!fs::exists(picturePath(folder, number))) return false;
  }
  return true;
}

/// Removes an older movie, which may be longer and would not match its label any longer.
void removeOlder(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name == "movie.json" || globMatches("frame_*.png", name)) fs::remove(entry.path());
  }
}

/// Draws a recording unless its movie exists. Returns false when stopped by `progress(picture)`.
bool makeMovie(OffscreenContext& context, const MovieOptions& options, Recording& recording,
               const fs::path& folder, const std::function<bool(std::uint32_t)>& progress) {
  const SceneInfo& scene = recording.scene();
  const fs::path label_path = folder / "movie.json";
  const std::string text = label(recording, options);
  const std::uint32_t pictures = pictureCount(recording, options);
  makeDirectory(folder);
  if (isComplete(folder, label_path, text, pictures)) return true;
  removeOlder(folder);
  for (std::uint32_t number = 0; number < pictures; ++number) {
    const Frame frame = recording.at(number * options.every);
    const std::vector<Pair> pairs = sweptPairs(frame.boxes, frame.filterIn(scene), scene.periodic);
    const PairRun all_pairs = pairs;
    writePng(picturePath(folder, number), drawFrame(context, scene, frame, {&all_pairs, 1},
                                                    options.picture.width, options.picture.height));
    if (!progress(number)) return false;
  }
  writeTextFile(label_path, text);
  return true;
}

}  // namespace

std::unique_ptr<OffscreenContext> prepareMovies(const MovieOptions& options) {
  try {
    auto context = makeOffscreenContext(options.picture.gl);
    makeDirectory(options.directory);
    return context;
  } catch (const RenderError& error) {
    throw InputError(fmt::format("--movie: {}", error.what()));
  }
}

bool makeMovies(OffscreenContext& context, const MovieOptions& options,
                std::vector<fs::path> recordings, bool quiet) {
  std::ranges::sort(recordings);
  std::set<fs::path> names;
  std::erase_if(recordings,
                [&](const fs::path& path) { return !names.insert(path.stem()).second; });
  std::uint64_t total = 0;
  for (const fs::path& path : recordings) total += pictureCount(*openRecordingFile(path), options);
  Progress progress(fmt::format("drawing {}", counted(recordings.size(), "movie")), total, quiet);
  std::uint64_t done = 0;
  for (const fs::path& path : recordings) {
    progress.detail(path.stem().string());
    const auto recording = openRecordingFile(path);
    const fs::path folder = options.directory / path.stem();
    const auto advance = [&](std::uint32_t picture) { return progress.advance(done + picture); };
    if (!makeMovie(context, options, *recording, folder, advance)) return false;
    progress.print("movie  " + folder.string());
    progress.update(done += pictureCount(*recording, options));
  }
  return true;
}

}  // namespace broadmark
