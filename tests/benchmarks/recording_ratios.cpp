// Compares .aabbs and .broadmark recordings of a scene: their sizes, and the time to read a frame
// when all are read in order, the two formats alternately, from files in the page cache. Targets
// of .broadmark, for a mostly static scene: a tenth of the bytes, and no slower than .aabbs.
//
//   recording_ratios [SCENE] [--objects N] [--frames F] [--rounds R]

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/contest.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/scenes/simulation.h"

namespace {

using namespace broadmark;
namespace fs = std::filesystem;

constexpr double kSmaller = 10;

struct Options {
  std::string scene = "city";
  std::uint32_t objects = 20'000;
  std::uint32_t frames = 300;
  int rounds = 9;
};

/// A recording and the time of the fastest pass through it.
struct TimedRecording {
  std::unique_ptr<Recording> recording;
  double seconds = std::numeric_limits<double>::infinity();

  void readThrough() {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    recordAll(*recording, [](const Frame&) {});
    seconds = std::min(seconds, std::chrono::duration<double>(Clock::now() - start).count());
  }
};

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Recordings of either kind: bytes, and time to read a frame");
  app.add_option("scene", options.scene)->capture_default_str();
  app.add_option("--objects", options.objects)->capture_default_str();
  app.add_option("--frames", options.frames)->capture_default_str();
  app.add_option("--rounds", options.rounds, "passes through each")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const auto simulation = makeSimulation(options.scene);
  setParameters(*simulation, {{"objects", std::to_string(options.objects)},
                              {"frames", std::to_string(options.frames)}});
  const SceneInfo scene = simulation->scene();
  const fs::path directory = fs::temp_directory_path();
  std::vector<std::unique_ptr<RecordingWriter>> writers;
  std::vector<fs::path> paths;
  for (const std::string_view extension : {kAabbsExtension, kBroadmarkExtension}) {
    paths.push_back(directory / recordingFileName(scene, extension));
    writers.push_back(std::make_unique<RecordingWriter>(paths.back(), scene));
  }
  recordAll(*simulation, [&](const Frame& frame) {
    for (const auto& writer : writers) writer->write(frame.boxes);
  });
  std::vector<TimedRecording> recordings;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    writers[i]->finish();
    recordings.push_back({openRecordingFile(paths[i])});
    fs::remove(paths[i]);  // the open file remains readable
  }
  for (int round = 0; round < options.rounds; ++round) {
    for (TimedRecording& recording : recordings) recording.readThrough();
  }
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    fmt::print("{:>10}  {:12} bytes  {:9.4f} ms a frame\n", paths[i].extension().string(),
               recordings[i].recording->bytes(),
               1e3 * recordings[i].seconds / (1.0 + scene.frames));
  }
  const double smaller = static_cast<double>(recordings[0].recording->bytes()) /
                         static_cast<double>(recordings[1].recording->bytes());
  const double faster = recordings[0].seconds / recordings[1].seconds;
  fmt::print("{} {} N{} F{}: {:.1f} times smaller, read {:.2f} times as fast\n", scene.name,
             scene.object_type, scene.objects, scene.frames, smaller, faster);
  return smaller >= kSmaller && faster >= 1 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  return broadmark::benchmarks::runMain("recording_ratios", run, argc, argv);
}
