// Frame time of the 3D view, by technique and number of bodies: with a turning camera and static
// bodies, and with moving bodies (as in playback). Only prints; has no targets.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include "broadmark/render/colouring.h"
#include "broadmark/render/offscreen_context.h"
#include "broadmark/render/scene_view.h"

namespace broadmark {
namespace {

constexpr float kSide = 100;

std::vector<Aabb> randomBoxes(std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> coordinate(-0.48F * kSide, 0.48F * kSide);
  std::uniform_real_distribution<float> factor(0.5F, 1.5F);
  const float side = 0.5F * kSide / std::cbrt(static_cast<float>(count));
  std::vector<Aabb> boxes(count);
  for (Aabb& box : boxes) {
    const float half = factor(random) * side / 2;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float centre = coordinate(random);
      box.min[axis] = centre - half;
      box.max[axis] = centre + half;
    }
  }
  return boxes;
}

/// The median time of work(i), in milliseconds.
template <class Work>
double medianOf(int repetitions, const Work& work) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> times;
  for (int i = 0; i < repetitions; ++i) {
    const auto start = Clock::now();
    work(i);
    times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  std::nth_element(times.begin(), times.begin() + repetitions / 2, times.end());
  return times[static_cast<std::size_t>(repetitions / 2)];
}

void measure(const Gl& gl, Technique technique, std::size_t count, int width, int height) {
  const std::vector<Aabb> boxes = randomBoxes(count);
  std::vector<std::uint32_t> overlaps(count);
  for (std::size_t body = 0; body < count; ++body) overlaps[body] = body % 4 == 0 ? 1 : 0;
  ColouringInput input;
  input.boxes = boxes;
  input.overlaps = overlaps;
  Colouring colouring;
  const double colour_ms =
      medianOf(7, [&](int) { colourModes().front().colour(input, colouring); });

  SceneViewOptions options;
  options.technique = technique;
  SceneView view(gl, options);
  view.resize(width, height);
  SceneViewContent content;
  content.world = {{-kSide / 2, -kSide / 2, -kSide / 2}, {kSide / 2, kSide / 2, kSide / 2}};
  content.space = viewSpaceOf(content.world);
  content.boxes = boxes;
  content.colours = colouring.colours;
  const OrbitCamera camera =
      focusedOn(viewedFrom({}, Direction::figure), content.space.toView(content.world),
                static_cast<double>(width) / height);
  view.draw(content, camera);
  gl.Finish();
  const int repetitions = count > 200'000 ? 5 : 11;
  const double turning_ms = medianOf(repetitions, [&](int i) {
    view.draw(content, orbited(camera, 0.01F * static_cast<float>(i + 1), 0));
    gl.Finish();
  });
  const double moving_ms = medianOf(repetitions, [&](int) {
    ++content.bodies_revision;
    view.draw(content, camera);
    gl.Finish();
  });
  fmt::print("{:>9} {:>6} {:>11.1f} {:>11.1f} {:>11.2f}\n", count,
             technique == Technique::gl ? "gl" : "splat", turning_ms, moving_ms, colour_ms);
}

}  // namespace
}  // namespace broadmark

int main(int argc, char** argv) {
  using namespace broadmark;
  CLI::App app("Milliseconds per frame of the 3D view, by technique");
  std::vector<std::size_t> counts = {32'000, 128'000, 1'000'000};
  int width = 1280;
  int height = 720;
  app.add_option("--bodies", counts, "Numbers of bodies")->delimiter(',');
  app.add_option("--width", width, "Pixels");
  app.add_option("--height", height, "Pixels");
  CLI11_PARSE(app, argc, argv);
  try {
    const auto context = makeOffscreenContext(GlSource::automatic);
    const Gl gl(*context);
    fmt::print("{}, {} x {}\n   bodies      by  turning ms   moving ms   colour ms\n",
               context->description(), width, height);
    for (const std::size_t count : counts) {
      for (const Technique technique : {Technique::splat, Technique::gl}) {
        measure(gl, technique, count, width, height);
      }
    }
  } catch (const RenderError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
