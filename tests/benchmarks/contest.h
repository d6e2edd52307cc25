// Contests of algorithms that alternate frame by frame on the same boxes: background load affects
// all of them, so that the ratios of their times are meaningful.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/algorithms.h"
#include "broadmark/change_detector.h"
#include "broadmark/harness/case_executor.h"
#include "broadmark/large_array.h"
#include "broadmark/statistics/statistics.h"

namespace broadmark::benchmarks {

/// The built-in algorithm with this id, or nothing.
inline std::optional<Algorithm> findAlgorithm(std::string_view id) {
  const std::vector<Algorithm> all = builtinAlgorithms();
  const auto found = std::ranges::find(all, id, &Algorithm::id);
  return found == all.end() ? std::nullopt : std::optional(*found);
}

/// A case of the built-in algorithm with this id, with the widest instruction set.
inline Case caseOf(std::string_view id, AnswerKind answer = AnswerKind::pairs, int threads = 1) {
  return makeCase(findAlgorithm(id).value(), bestIsa(), threads, "", {}, answer);
}

/// A case on the contest's scene, with the times of its frames so far.
struct Contestant {
  std::string name;
  std::unique_ptr<CaseExecutor> host;
  float margin = 0;
  std::vector<double> milliseconds = {};

  [[nodiscard]] double median() const { return quantile(milliseconds, 0.5); }
  /// The pairs of the last frame.
  [[nodiscard]] PairRuns answer() const { return host->answer(); }
};

/// Contestants on the same frames, played forwards and backwards, so that all motion is smooth.
class Contest {
 public:
  /// `frames` must not be empty. Copies them as recordings do: large frames into huge pages.
  explicit Contest(std::string name, std::span<const std::vector<Aabb>> frames) {
    for (const std::vector<Aabb>& frame : frames) frames_.emplace_back(frame.begin(), frame.end());
    scene_.name = std::move(name);
    scene_.object_type = "Cubes";
    scene_.objects = static_cast<std::uint32_t>(frames_[0].size());
    scene_.world = frames_[0][0];
    for (const Aabb& box : frames_[0]) scene_.world = merged(scene_.world, box);
  }

  [[nodiscard]] const SceneInfo& scene() const { return scene_; }

  /// Throws InputError (parameters) and UnsupportedError.
  void add(std::string name, const Case& entered,
           const ExecutorFactory& make_executor = makeInProcessExecutor) {
    Contestant added = {std::move(name), make_executor(entered, {}),
                        makeInstance(entered)->margin()};
    added.host->start(scene_, changed_bodies_.complete({0, frames_[0]}));
    contestants_.push_back(std::move(added));
  }

  /// May be called repeatedly; continues with the next frame.
  void run(int rounds) {
    if (next_frame_ == 1) {
      playRound();  // warms up
      for (Contestant& contestant : contestants_) contestant.milliseconds.clear();
    }
    for (int round = 0; round < rounds; ++round) playRound();
  }

  [[nodiscard]] const Contestant& find(std::string_view name) const {
    return *std::ranges::find(contestants_, name, &Contestant::name);
  }

  /// Time of `a` / time of `b`, in each round.
  [[nodiscard]] std::vector<double> ratios(std::string_view a, std::string_view b) const {
    const std::vector<double>& times_a = find(a).milliseconds;
    const std::vector<double>& times_b = find(b).milliseconds;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < times_a.size(); ++i) ratios.push_back(times_a[i] / times_b[i]);
    return ratios;
  }
  /// The median of ratios().
  [[nodiscard]] double ratio(std::string_view a, std::string_view b) const {
    return quantile(ratios(a, b), 0.5);
  }

 private:
  void playRound() {
    // A random order, so that no contestant is always the first.
    std::vector<std::size_t> order(contestants_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::shuffle(order, random_);
    const std::uint32_t index = next_frame_++;
    const Frame frame = changed_bodies_.complete({index, boxesOf(index)});
    for (const std::size_t i : order) {
      Contestant& contestant = contestants_[i];
      const std::int64_t ns = contestant.host->step(frame).times[Phase::total];
      contestant.milliseconds.push_back(static_cast<double>(ns) * 1e-6);
    }
  }

  [[nodiscard]] std::span<const Aabb> boxesOf(std::uint32_t index) const {
    const std::size_t last = frames_.size() - 1;
    if (last == 0) return frames_[0];
    const std::size_t phase = index % (2 * last);
    return frames_[phase <= last ? phase : 2 * last - phase];
  }

  SceneInfo scene_;
  std::vector<LargeVector<Aabb>> frames_;
  ChangeDetector changed_bodies_;
  std::vector<Contestant> contestants_;
  std::uint32_t next_frame_ = 1;
  std::mt19937 random_;
};

/// Implements main() of a benchmark: `benchmark(argc, argv)` returns the exit status. Prints an
/// exception with the benchmark's name; the exit status is then 2.
template <class Benchmark>
int runMain(const char* name, Benchmark benchmark, int argc, char** argv) {
  try {
    return benchmark(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 2;
  }
}

}  // namespace broadmark::benchmarks
