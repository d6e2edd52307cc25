// The broad-phase library beside the program's algorithms that it consists of: what its checks and
// its order cost. The contestants alternate frame by frame, on the same boxes.
//
//   broadphase_ratios [ROUNDS [BODIES...]]

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/broadphase.hpp"
#include "broadmark/change_detector.h"
#include "columns.h"
#include "tide.h"
#include "torture/inputs.h"

namespace {

using namespace broadmark;
namespace bp = broadmark::broadphase;

/// The library's class, or an algorithm; each with the name and times of its frames.
struct Contestant {
  std::string name;
  /// Takes the boxes of a frame twice: as the library and as the program do.
  std::function<void(const Frame& frame, const std::vector<bp::Box>& boxes)> update;
  std::vector<double> microseconds = {};
};

Contestant algorithm(std::string name, std::unique_ptr<BroadPhase> made, ExecutionContext& context,
                     bool events, const SceneInfo& scene, const Frame& first) {
  std::shared_ptr<BroadPhase> instance = std::move(made);
  if (events) instance->reportEvents();
  instance->initialize(scene, first, context);
  return {std::move(name), [instance](const Frame& frame, const std::vector<bp::Box>&) {
            instance->updateObjects(frame);
            instance->cleanCache();
            instance->updateStructures();
            instance->searchOverlaps();
          }};
}

Contestant library(std::string name, const bp::Options& options) {
  const auto object = std::make_shared<bp::BroadPhase>(options);
  return {std::move(name),
          [object](const Frame&, const std::vector<bp::Box>& boxes) { object->update(boxes); }};
}

void measure(std::size_t bodies, double moving, bool events, int rounds) {
  std::vector<Aabb> boxes = inputs::uniform(bodies, 0, 1);
  std::vector<bp::Box> given(bodies);
  SceneInfo scene;
  scene.objects = static_cast<std::uint32_t>(bodies);
  ChangeDetector detector;
  Frame frame = detector.complete({0, boxes});
  ExecutionContext context(1, bestIsa());
  std::vector<Contestant> all;
  all.push_back(algorithm("tide", tide::create(), context, events, scene, frame));
  if (!events) all.push_back(algorithm("columns", columns::create(), context, false, scene, frame));
  for (const bp::Method method : {bp::Method::tide, bp::Method::columns}) {
    if (events && method == bp::Method::columns) continue;
    for (const bp::Order order : {bp::Order::any, bp::Order::sorted}) {
      bp::Options options;
      options.method = method;
      options.order = order;
      options.answer = events ? bp::Answer::events : bp::Answer::pairs;
      all.push_back(
          library(std::string(method == bp::Method::tide ? "library tide" : "library columns") +
                      (order == bp::Order::sorted ? ", sorted" : ""),
                  options));
    }
  }
  std::vector<double> detection;
  inputs::Random random(2, 0);
  for (int round = 0; round < rounds + 3; ++round) {
    const auto movers = static_cast<std::size_t>(moving * static_cast<double>(bodies));
    for (std::size_t i = 0; i < movers; ++i) {
      Aabb& box =
          boxes[movers == bodies
                    ? i
                    : static_cast<std::size_t>(random.integer(0, static_cast<int>(bodies) - 1))];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float step = random.uniform(-0.1F, 0.1F);
        box.min[axis] += step;
        box.max[axis] += step;
      }
    }
    for (std::size_t i = 0; i < bodies; ++i) {
      std::copy_n(boxes[i].min.begin(), 3, given[i].min);
      std::copy_n(boxes[i].max.begin(), 3, given[i].max);
    }
    const auto time = [&](const auto& call, std::vector<double>& times) {
      const auto begin = std::chrono::steady_clock::now();
      call();
      const std::chrono::duration<double, std::micro> span =
          std::chrono::steady_clock::now() - begin;
      if (round >= 3) times.push_back(span.count());
    };
    const auto index = static_cast<std::uint32_t>(round + 1);
    time([&] { frame = detector.complete({index, boxes}); }, detection);
    for (Contestant& contestant : all) {
      time([&] { contestant.update(frame, given); }, contestant.microseconds);
    }
  }
  // What disturbs a frame only makes it slower.
  const auto quickest = [](std::vector<double>& values) {
    std::ranges::sort(values);
    return values[values.size() / 10];
  };
  fmt::print("{} bodies, {:g} % move, {}: changes {:.1f} us", bodies, 100 * moving,
             events ? "events" : "pairs", quickest(detection));
  for (Contestant& contestant : all) {
    fmt::print("; {} {:.1f}", contestant.name, quickest(contestant.microseconds));
  }
  fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 101;
  std::vector<std::size_t> sizes;
  for (int i = 2; i < argc; ++i) sizes.push_back(static_cast<std::size_t>(std::atoi(argv[i])));
  if (sizes.empty()) sizes = {1000, 8000, 128'000};
  for (const std::size_t bodies : sizes) {
    for (const bool events : {false, true}) {
      for (const double moving : {0.0, 0.01, 0.1, 1.0}) measure(bodies, moving, events, rounds);
    }
  }
}
