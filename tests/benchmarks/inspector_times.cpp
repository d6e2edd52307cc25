// Whether the inspector measures what a headless run measures: the same cases on the same frames in
// turn, once by runCase(), once by the inspector while it plays and draws. Prints the ratio of the
// medians of a frame's total time (1: they agree), and how many of the inspector's frames were
// disturbed.
//
// Then how long it takes from a click on an earlier frame to its picture: one that has been seen,
// and one that an algorithm has to run to again, for its structure.
//
//   inspector_times [--objects N] [--frames F] [--rounds R] [--seek-objects N] [--seek-from F]
//                   [--seek-to F]

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>

#include "benchmarks/contest.h"
#include "broadmark/algorithms.h"
#include "broadmark/render/framebuffer.h"
#include "broadmark/runner.h"
#include "inspector/inspector.h"

namespace {

using namespace broadmark;

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Setting {
  std::string algorithm;
  std::string objects;
  std::string frames;
};

std::unique_ptr<Simulation> simulationOf(const Setting& setting) {
  auto simulation = makeSimulation("brownian", "kinematic");
  setParameters(*simulation, {{"objects", setting.objects}, {"frames", setting.frames}});
  return simulation;
}

std::vector<double> headlessTimes(const Setting& setting) {
  const auto simulation = simulationOf(setting);
  const CaseResult result = runCase(benchmarks::caseOf(setting.algorithm), *simulation);
  std::vector<double> times;
  for (const FrameTimes& frame : result.repetitions.at(0).frames) {
    times.push_back(static_cast<double>(frame[Phase::total]));
  }
  return times;
}

constexpr int kWidth = 1280;
constexpr int kHeight = 720;

/// The inspector with a simulation and one algorithm on one thread.
struct Watched {
  Watched(const Gl& gl, const Setting& setting)
      : target(gl, kWidth, kHeight, 1), inspector(gl, builtinAlgorithms(), {}, 1) {
    session().draft = simulationOf(setting);
    session().simulate();
    LaneEdit& lane = session().lanes.add(setting.algorithm);
    lane.threads = 1;
    session().lanes.changed();
  }

  [[nodiscard]] Session& session() { return inspector.session(); }
  void draw() {
    inspector.draw(input, kWidth, kHeight, 1.0 / 60, [&] { target.bind(); });
  }
  /// Draws until a picture shows what is wanted. Returns the seconds since the call.
  template <class IsThere>
  double drawUntil(const IsThere& is_there) {
    const auto start = std::chrono::steady_clock::now();
    for (bool there = false; !there;) {
      session().runs.look([&](const RunProgress& progress) {
        there = progress.snapshot && is_there(*progress.snapshot);
      });
      draw();
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  Framebuffer target;
  Inspector inspector;
  InputQueue input;
};

struct Seek {
  std::string objects = "128000";
  std::uint32_t from = 300;
  std::uint32_t to = 100;
};

void printSeekTimes(const Gl& gl, const Seek& seek, const char* algorithm) {
  Watched watched(
      gl, {.algorithm = algorithm, .objects = seek.objects, .frames = std::to_string(seek.from)});
  watched.drawUntil([](const Snapshot& snapshot) { return snapshot.frame == 0; });
  watched.session().playback.goTo(seek.from);
  watched.drawUntil([&](const Snapshot& snapshot) { return snapshot.frame == seek.from; });
  watched.session().playback.goTo(seek.to);
  const double seen =
      watched.drawUntil([&](const Snapshot& snapshot) { return snapshot.frame == seek.to; });
  watched.session().view.structure = true;
  const double run_again =
      watched.drawUntil([](const Snapshot& snapshot) { return snapshot.structure != nullptr; });
  fmt::print("{:12} frame {} to {} of {} bodies: seen {:.0f} ms, run again {:.1f} s\n", algorithm,
             seek.from, seek.to, seek.objects, 1000 * seen, run_again);
}

struct InspectorTimes {
  std::vector<double> times;  ///< of the undisturbed frames
  int disturbed = 0;
};

InspectorTimes inspectorTimes(const Gl& gl, const Setting& setting) {
  Watched watched(gl, setting);
  Session& session = watched.session();
  session.playback.frames_per_second = 1000;
  InspectorTimes result;
  for (bool playing = false, done = false; !done;) {
    watched.draw();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    session.runs.look([&](const RunProgress& progress) {
      if (!progress.snapshot) return;
      done = playing && progress.snapshot->frame == progress.scene.frames;
      if (!done) return;
      for (const FrameRecord& record : progress.lanes.at(0).frames) {
        result.disturbed += record.disturbed ? 1 : 0;
        if (!record.disturbed) {
          result.times.push_back(static_cast<double>(record.times[Phase::total]));
        }
      }
    });
    if (!playing && session.playback.lastFrame() > 0) {
      session.play(true);
      playing = true;
    }
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Compares the times that the inspector measures with those of a headless run.");
  Setting setting{.objects = "8000", .frames = "60"};
  int rounds = 3;
  Seek seek;
  app.add_option("--objects", setting.objects)->capture_default_str();
  app.add_option("--frames", setting.frames)->capture_default_str();
  app.add_option("--rounds", rounds)->capture_default_str();
  app.add_option("--seek-objects", seek.objects)->capture_default_str();
  app.add_option("--seek-from", seek.from)->capture_default_str();
  app.add_option("--seek-to", seek.to)->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const auto context = makeOffscreenContext(GlSource::automatic);
  const Gl gl(*context);
  fmt::print("{:12} {:>12} {:>12} {:>7} {:>10}\n", "algorithm", "headless", "inspector", "ratio",
             "disturbed");
  for (const char* algorithm : {"sap", "sap-simd", "grid-bf", "kd", "tracy", "dbvt-d"}) {
    setting.algorithm = algorithm;
    std::vector<double> headless;
    std::vector<double> inspector;
    int disturbed = 0;
    for (int round = 0; round < rounds; ++round) {
      headless.push_back(median(headlessTimes(setting)));
      const InspectorTimes seen = inspectorTimes(gl, setting);
      inspector.push_back(median(seen.times));
      disturbed += seen.disturbed;
    }
    const double a = median(headless);
    const double b = median(inspector);
    fmt::print("{:12} {:>9.1f} µs {:>9.1f} µs {:>7.2f} {:>10}\n", algorithm, a / 1000, b / 1000,
               b / a, disturbed);
  }
  for (const char* algorithm : {"columns", "tracy"}) printSeekTimes(gl, seek, algorithm);
  return 0;
}
