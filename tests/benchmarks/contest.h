// Algorithms that take turns, frame by frame, on the same boxes: anything else that slows the
// machine slows all of them, so that ratios of their times mean something.
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

/// The built-in algorithm of that id, or nothing.
inline std::optional<Algorithm> findAlgorithm(std::string_view id) {
  const std::vector<Algorithm> all = builtinAlgorithms();
  const auto found = std::ranges::find(all, id, &Algorithm::id);
  return found == all.end() ? std::nullopt : std::optional(*found);
}

/// The built-in algorithm of that id, which must be there, with the widest instruction set.
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
  /// Of the last frame.
  [[nodiscard]] PairRuns answer() const { return host->answer(); }
};

/// Contestants on the same frames, which are gone through to and fro, so that all motion is smooth.
class Contest {
 public:
  /// `frames` must not be empty. They are copied to where recordings keep theirs: large ones into
  /// huge pages.
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
           const ExecutorFactory& make_host = makeLocalHost) {
    Contestant added = {std::move(name), make_host(entered, {}), makeInstance(entered)->margin()};
    added.host->start(scene_, changed_bodies_.complete({0, frames_[0]}));
    contestants_.push_back(std::move(added));
  }

  /// May be called again, to go on.
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
    const std::vector<double>& of_a = find(a).milliseconds;
    const std::vector<double>& of_b = find(b).milliseconds;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < of_a.size(); ++i) ratios.push_back(of_a[i] / of_b[i]);
    return ratios;
  }
  /// Their median.
  [[nodiscard]] double ratio(std::string_view a, std::string_view b) const {
    return quantile(ratios(a, b), 0.5);
  }

 private:
  void playRound() {
    // Nobody always comes first.
    std::vector<std::size_t> order(contestants_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::shuffle(order, random_);
    const std::uint32_t index = next_frame_++;
    const Frame frame = changed_bodies_.complete({index, boxesOf(index)});
    for (const std::size_t turn : order) {
      Contestant& contestant = contestants_[turn];
      const std::int64_t ns = contestant.host->step(frame).times[Phase::total];
      contestant.milliseconds.push_back(static_cast<double>(ns) * 1e-6);
    }
  }

  [[nodiscard]] std::span<const Aabb> boxesOf(std::uint32_t index) const {
    const std::size_t last = frames_.size() - 1;
    if (last == 0) return frames_[0];
    const std::size_t way = index % (2 * last);
    return frames_[way <= last ? way : 2 * last - way];
  }

  SceneInfo scene_;
  std::vector<LargeVector<Aabb>> frames_;
  ChangeDetector changed_bodies_;
  std::vector<Contestant> contestants_;
  std::uint32_t next_frame_ = 1;
  std::mt19937 random_;
};

/// What main() of a benchmark does: run(argc, argv) returns the exit status; an exception is
/// printed behind the benchmark's name, and the status is 2.
template <class Run>
int runMain(const char* name, Run run, int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 2;
  }
}

}  // namespace broadmark::benchmarks
