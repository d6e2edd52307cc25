// The broad-phase library beside those of engines, in an engine's loop: in each step bodies are
// removed, added and moved, pairs are found, and queries are answered: a box and a ray of up to ten
// cubes' length for every hundred bodies. Each broad phase gives what its engine takes from it: all
// pairs, those of active bodies, or events. One thread. All of them are given the same step, in
// random order, then the next. Pairs and answers are compared, beyond the time measured.
//
//   engine_loop_ratios [ROUNDS [BODIES...]]
//
// Printed: the mean times of a step, since some spread work over several steps, without the slowest
// tenth of the steps, which other programs have disturbed; and the pairs that an engine is given
// for each one that overlaps, as trees with enlarged boxes give more.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

// Jolt's headers must precede the others'.
#if BROADMARK_JOLT
#include "benchmarks/engine_loop/jolt.h"
#endif
#if BROADMARK_PHYSX
#include "benchmarks/engine_loop/physx.h"
#endif
#if BROADMARK_BOX3D
#include "benchmarks/engine_loop/box3d.h"
#endif
#include "benchmarks/engine_loop/bullet.h"
#include "benchmarks/engine_loop/library.h"
#include "benchmarks/engine_loop/loop.h"

namespace {

using namespace broadmark;
using namespace broadmark::benchmarks;

struct Times {
  double change_ns = 0;
  double pairs_ns = 0;
  double queries_ns = 0;

  [[nodiscard]] double total() const { return change_ns + pairs_ns + queries_ns; }
};

struct Contestant {
  std::string name;
  std::unique_ptr<LoopBroadPhase> broad_phase;
  std::vector<Times> steps = {};  ///< measured ones
  // Sums over all measured steps; wrong ones over all.
  std::size_t given_pairs = 0;
  std::size_t overlapping_pairs = 0;
  std::size_t wrong_pairs = 0;
  std::size_t wrong_answers = 0;

  /// Without the slowest tenth of the steps.
  [[nodiscard]] Times mean() {
    std::ranges::sort(steps, {}, &Times::total);
    const std::size_t count = steps.size() - steps.size() / 10;
    Times mean;
    for (const Times& step : std::span(steps).first(count)) {
      mean.change_ns += step.change_ns / static_cast<double>(count);
      mean.pairs_ns += step.pairs_ns / static_cast<double>(count);
      mean.queries_ns += step.queries_ns / static_cast<double>(count);
    }
    return mean;
  }
};

std::vector<Contestant> contestants() {
  std::vector<Contestant> all;
  const auto add = [&](const char* name, std::unique_ptr<LoopBroadPhase> broad_phase) {
    all.push_back({name, std::move(broad_phase)});
  };
  const auto library = [](bp::Method method, bp::Answer answer) {
    return std::make_unique<LibraryLoop>(method, answer);
  };
  add("tide, events", library(bp::Method::tide, bp::Answer::events));
  add("tide, pairs", library(bp::Method::tide, bp::Answer::pairs));
  add("columns, pairs", library(bp::Method::columns, bp::Answer::pairs));
  add("Bullet", std::make_unique<BulletLoop>(false));
  add("Bullet deferred", std::make_unique<BulletLoop>(true));
#if BROADMARK_BOX3D
  add("Box3D", std::make_unique<Box3dLoop>());
#endif
#if BROADMARK_JOLT
  add("Jolt", std::make_unique<JoltLoop>());
#endif
#if BROADMARK_PHYSX
  add("PhysX", std::make_unique<PhysXLoop>());
#endif
  return all;
}

/// The pairs that overlap, sorted.
std::vector<Pair> overlapping(const std::vector<Pair>& given, const Step& step) {
  std::vector<Pair> pairs;
  std::ranges::copy_if(given, std::back_inserter(pairs),
                       [&](Pair pair) { return overlaps(step.boxes[pair.a], step.boxes[pair.b]); });
  std::ranges::sort(pairs);
  return pairs;
}

std::vector<Pair> activeOnly(const std::vector<Pair>& all, const Step& step) {
  std::vector<Pair> pairs;
  std::ranges::copy_if(all, std::back_inserter(pairs), [&](Pair pair) {
    return (step.is_active[pair.a] | step.is_active[pair.b]) != 0;
  });
  return pairs;
}

/// Queries whose answers differ; hits may do so by rounding.
std::size_t differences(const Answers& a, const Answers& b) {
  const auto differ = [](float x, float y) { return x != y && !(std::abs(x - y) < 1e-4F); };
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.overlaps.size(); ++i) count += a.overlaps[i] != b.overlaps[i];
  for (std::size_t i = 0; i < a.fractions.size(); ++i) {
    count += differ(a.fractions[i], b.fractions[i]) ? 1 : 0;
  }
  return count;
}

Batch queriesOf(std::size_t bodies, std::uint64_t round) {
  Batch batch = batchIn(bodies, std::max<std::size_t>(bodies / 100, 10), 1000 + round);
  for (bp::Cast& ray : batch.rays) {
    const float length = std::hypot(ray.direction[0], ray.direction[1], ray.direction[2]);
    for (float& x : ray.direction) x *= std::min(1.0F, 10 / length);
  }
  return batch;
}

void measure(std::size_t bodies, double moving, int rounds) {
  constexpr int kWarmUp = 20;  // steps
  LoopWorld world(bodies, moving);
  std::vector<Contestant> all = contestants();
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 random;
  std::vector<Answers> answers(all.size());
  std::vector<Pair> given;
  for (int round = -kWarmUp; round < rounds; ++round) {
    const Step& step = world.current();
    const Batch batch = queriesOf(bodies, static_cast<std::uint64_t>(round + kWarmUp));
    std::ranges::shuffle(order, random);
    for (const std::size_t i : order) {
      Contestant& contestant = all[i];
      LoopBroadPhase& broad_phase = *contestant.broad_phase;
      answers[i].clear(batch);
      Times times;
      times.change_ns = nanosecondsOf([&] { broad_phase.change(step); });
      times.pairs_ns = nanosecondsOf([&] { broad_phase.findPairs(); });
      times.queries_ns = nanosecondsOf([&] { broad_phase.answer(batch, answers[i]); });
      if (round >= 0) contestant.steps.push_back(times);
    }
    std::vector<Pair> right;
    for (std::size_t i = 0; i < all.size(); ++i) {
      Contestant& contestant = all[i];
      given.clear();
      contestant.broad_phase->appendPairs(given);
      const std::vector<Pair> pairs = overlapping(given, step);
      if (i == 0) right = pairs;
      const std::vector<Pair> expected =
          contestant.broad_phase->findsActiveOnly() ? activeOnly(right, step) : right;
      std::vector<Pair> wrong;
      std::ranges::set_symmetric_difference(pairs, expected, std::back_inserter(wrong));
      contestant.wrong_pairs += wrong.size();
      contestant.wrong_answers += differences(answers[i], answers[0]);
      if (round < 0) continue;
      contestant.given_pairs += given.size();
      contestant.overlapping_pairs += pairs.size();
    }
    world.advance();
  }
  fmt::print("{} bodies, {:g} % move: ms a step\n{:16}{:>9}{:>9}{:>9}{:>9}{:>8}{:>8}\n", bodies,
             100 * moving, "", "change", "pairs", "queries", "total", "ratio", "given");
  const double library_ns = all[0].mean().total();
  for (Contestant& contestant : all) {
    const Times mean = contestant.mean();
    fmt::print("{:16}{:9.3f}{:9.3f}{:9.3f}{:9.3f}{:8.2f}{:8.2f}\n", contestant.name,
               mean.change_ns / 1e6, mean.pairs_ns / 1e6, mean.queries_ns / 1e6, mean.total() / 1e6,
               mean.total() / library_ns,
               static_cast<double>(contestant.given_pairs) /
                   static_cast<double>(std::max<std::size_t>(contestant.overlapping_pairs, 1)));
    if (contestant.wrong_pairs + contestant.wrong_answers > 0) {
      fmt::print(
          "  differs from the library: {} pairs, {} answers of {}\n", contestant.wrong_pairs,
          contestant.wrong_answers,
          2 * std::max<std::size_t>(bodies / 100, 10) * static_cast<std::size_t>(rounds + kWarmUp));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const LibraryArguments arguments(argc, argv, 1, {1000, 8000, 64'000});
  for (const std::size_t bodies : arguments.sizes) {
    for (const double moving : {0.1, 1.0}) measure(bodies, moving, arguments.rounds);
  }
}
