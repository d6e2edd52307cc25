// The broad-phase library beside the program's algorithms that it consists of: what its checks and
// its order cost. The contestants alternate frame by frame, on the same boxes.
//
//   broadphase_ratios [ROUNDS [BODIES...]]

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/library_benchmark.h"
#include "broadmark/broadphase.hpp"
#include "broadmark/change_detector.h"
#include "broadmark/statistics/statistics.h"
#include "columns.h"
#include "tide.h"
#include "torture/inputs.h"

namespace {

using namespace broadmark;
using namespace broadmark::benchmarks;

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
    moveShare(boxes, moving, random);
    for (std::size_t i = 0; i < bodies; ++i) {
      std::copy_n(boxes[i].min.begin(), 3, given[i].min);
      std::copy_n(boxes[i].max.begin(), 3, given[i].max);
    }
    const auto time = [&](const auto& call, std::vector<double>& times) {
      const double microseconds = nanosecondsOf(call) / 1000;
      if (round >= 3) times.push_back(microseconds);
    };
    const auto index = static_cast<std::uint32_t>(round + 1);
    time([&] { frame = detector.complete({index, boxes}); }, detection);
    for (Contestant& contestant : all) {
      time([&] { contestant.update(frame, given); }, contestant.microseconds);
    }
  }
  // What disturbs a frame only makes it slower.
  const auto quickest = [](const std::vector<double>& values) { return quantile(values, 0.1); };
  fmt::print("{} bodies, {:g} % move, {}: changes {:.1f} us", bodies, 100 * moving,
             events ? "events" : "pairs", quickest(detection));
  for (const Contestant& contestant : all) {
    fmt::print("; {} {:.1f}", contestant.name, quickest(contestant.microseconds));
  }
  fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
  const LibraryArguments arguments(argc, argv, 1, {1000, 8000, 128'000});
  for (const std::size_t bodies : arguments.sizes) {
    for (const bool events : {false, true}) {
      for (const double moving : {0.0, 0.01, 0.1, 1.0}) {
        measure(bodies, moving, events, arguments.rounds);
      }
    }
  }
}
