// Compares times that the inspector measures with those of a headless run: the same cases on the
// same frames, alternately by runCase() and by the inspector while it plays and draws. Prints the
// ratio of the medians of a frame's total time (1: they agree), and the number of disturbed frames
// in the inspector.
//
// Then the latency from a click on an earlier frame to its picture: of a frame in the cache, and of
// one that an algorithm has to run to again, for its structure.
//
// Then the number of pictures per second as the inspector opens and with all options on, while the
// camera turns and during playback.
//
//   inspector_times [--objects N] [--frames F] [--rounds R] [--seek-from F] [--seek-to F]
//                   [--crowd N]

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <numeric>
#include <set>

#include "benchmarks/contest.h"
#include "broadmark/algorithms.h"
#include "broadmark/harness/runner.h"
#include "broadmark/render/framebuffer.h"
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
    session().draft.adopt(simulationOf(setting));
    session().draft.simulate();
    TrackEdit& track = session().tracks.add(setting.algorithm);
    track.test_case.threads = 1;
    session().tracks.applyEdits();
  }

  [[nodiscard]] Session& session() { return inspector.session(); }
  void draw() {
    inspector.draw(input, kWidth, kHeight, 1.0 / 60, [&] { target.bind(); });
  }
  /// Draws until the condition holds for a snapshot. Returns the elapsed seconds.
  template <class Condition>
  double drawUntil(const Condition& condition) {
    const auto start = std::chrono::steady_clock::now();
    bool done = false;
    while (!done) {
      session().runs.readProgress([&](const RunProgress& progress) {
        done = progress.snapshot && condition(*progress.snapshot);
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
  std::uint32_t from = 300;
  std::uint32_t to = 100;
};

void printSeekTimes(const Gl& gl, const Seek& seek, const std::string& crowd,
                    const char* algorithm) {
  Watched watched(gl,
                  {.algorithm = algorithm, .objects = crowd, .frames = std::to_string(seek.from)});
  watched.drawUntil([](const Snapshot& snapshot) { return snapshot.frame == 0; });
  watched.session().playback.goTo(seek.from);
  watched.drawUntil([&](const Snapshot& snapshot) { return snapshot.frame == seek.from; });
  watched.session().playback.goTo(seek.to);
  const double seen =
      watched.drawUntil([&](const Snapshot& snapshot) { return snapshot.frame == seek.to; });
  watched.session().display.structure = true;
  const double run_again =
      watched.drawUntil([](const Snapshot& snapshot) { return snapshot.structure != nullptr; });
  fmt::print("{:12} frame {} to {} of {} bodies: seen {:.0f} ms, run again {:.1f} s\n", algorithm,
             seek.from, seek.to, crowd, 1000 * seen, run_again);
}

/// Enables all drawing: cells of the algorithm, lines between all pairs, selected bodies through
/// others, a second view with another algorithm's answer, both in the timeline.
void showEverything(Session& session) {
  session.tracks.add("grid2d-sap");
  DisplayOptions& view = session.display;
  view.pair_lines = view.all_pair_lines = view.xray = view.structure = true;
  view.structure_near = false;
  view.filter = {.largest = 1e6};
  session.selection.select({0, 1, 2, 3});
  session.showSecond(true);
}

/// The milliseconds of each picture while draw_picture() is called for some seconds; without the
/// first picture, which uploads new data.
template <class DrawPicture>
std::vector<double> pictureTimes(const DrawPicture& draw_picture) {
  constexpr double kSeconds = 5;
  std::vector<double> times;
  draw_picture();
  for (double sum = 0; sum < 1000 * kSeconds; sum += times.back()) {
    const auto start = std::chrono::steady_clock::now();
    draw_picture();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count());
  }
  return times;
}

void printPictureTimes(const Gl& gl, const std::string& crowd, bool everything) {
  Watched watched(gl, {.algorithm = "columns", .objects = crowd, .frames = "2000"});
  Session& session = watched.session();
  if (everything) showEverything(session);
  watched.drawUntil([](const Snapshot& snapshot) { return snapshot.frame == 0; });
  session.playback.goTo(1);  // frame 0 has no answer yet
  watched.drawUntil([&](const Snapshot& snapshot) {
    return snapshot.frame == 1 && (!everything || snapshot.structure != nullptr);
  });
  session.runs.waitUntilIdle(std::chrono::seconds(60));
  // Counts different pictures only: to redraw an unchanged picture costs little.
  const auto print = [&](const char* mode, std::vector<double> times, std::size_t changes) {
    const double seconds = std::accumulate(times.begin(), times.end(), 0.0) / 1000;
    std::ranges::sort(times);
    fmt::print("{} bodies, {}, {:8} {:5.1f} different pictures a second (95 %: {:.1f} ms)\n", crowd,
               everything ? "everything on" : "as opened", mode,
               static_cast<double>(changes) / seconds, times[times.size() * 95 / 100]);
  };
  float x = 0.4F * kWidth;  // in the first view
  const auto move_mouse = [&] {
    watched.input.push({.kind = InputEvent::Kind::move, .x = x, .y = kHeight / 3.0F});
    x += 3;
  };
  move_mouse();
  watched.input.push({.kind = InputEvent::Kind::button, .code = 0, .down = true});
  const std::vector<double> turning = pictureTimes([&] {
    move_mouse();
    watched.draw();
    gl.Finish();
  });
  print("turning", turning, turning.size());
  watched.input.push({.kind = InputEvent::Kind::button, .code = 0, .down = false});
  session.playback.frames_per_second = 1000;
  session.play(true);
  std::set<std::uint32_t> frames;
  const std::vector<double> playing = pictureTimes([&] {
    watched.draw();
    gl.Finish();
    session.runs.readProgress(
        [&](const RunProgress& progress) { frames.insert(progress.snapshot->frame); });
  });
  print("playing", playing, frames.size());
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
    session.runs.readProgress([&](const RunProgress& progress) {
      if (!progress.snapshot) return;
      done = playing && progress.snapshot->frame == progress.scene.frames;
      if (!done) return;
      for (const FrameRecord& record : progress.tracks.at(0).frames) {
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
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  CLI::App app("Compares the times that the inspector measures with those of a headless run.");
  Setting setting{.objects = "8000", .frames = "60"};
  int rounds = 3;
  Seek seek;
  std::string crowd = "128000";
  app.add_option("--objects", setting.objects)->capture_default_str();
  app.add_option("--frames", setting.frames)->capture_default_str();
  app.add_option("--rounds", rounds)->capture_default_str();
  app.add_option("--seek-from", seek.from)->capture_default_str();
  app.add_option("--seek-to", seek.to)->capture_default_str();
  app.add_option("--crowd", crowd, "bodies of what follows the ratios")->capture_default_str();
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
      const InspectorTimes measured = inspectorTimes(gl, setting);
      inspector.push_back(median(measured.times));
      disturbed += measured.disturbed;
    }
    const double a = median(headless);
    const double b = median(inspector);
    fmt::print("{:12} {:>9.1f} µs {:>9.1f} µs {:>7.2f} {:>10}\n", algorithm, a / 1000, b / 1000,
               b / a, disturbed);
  }
  for (const char* algorithm : {"columns", "tracy"}) printSeekTimes(gl, seek, crowd, algorithm);
  for (const bool everything : {false, true}) printPictureTimes(gl, crowd, everything);
  return 0;
}
