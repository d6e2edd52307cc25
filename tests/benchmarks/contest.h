// Algorithms that take turns, frame by frame, on the same boxes: anything else that slows the
// machine slows all of them, so that ratios of their times mean something.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/algorithms.h"
#include "broadmark/case_run.h"
#include "broadmark/error.h"
#include "broadmark/statistics.h"

namespace broadmark::benchmarks {

/// The built-in algorithm of that id, or nothing.
inline std::optional<Algorithm> findAlgorithm(std::string_view id) {
  const std::vector<Algorithm> all = builtinAlgorithms();
  const auto found = std::ranges::find(all, id, &Algorithm::id);
  return found == all.end() ? std::nullopt : std::optional(*found);
}

/// A case on the contest's scene, with the times of its frames so far.
struct Contestant {
  std::string name;
  std::unique_ptr<CaseRun> run;
  std::vector<double> milliseconds;

  [[nodiscard]] double median() const { return quantile(milliseconds, 0.5); }
  /// Of the last frame.
  [[nodiscard]] PairRuns answer() const { return run->algorithm().overlaps(); }
};

/// Contestants on the same frames, which are gone through to and fro, so that all motion is smooth.
class Contest {
 public:
  /// `frames` must not be empty; borrowed.
  explicit Contest(std::string name, std::span<const std::vector<Aabb>> frames) : frames_(frames) {
    scene_.name = std::move(name);
    scene_.object_type = "Cubes";
    scene_.objects = static_cast<std::uint32_t>(frames_[0].size());
    scene_.world = frames_[0][0];
    for (const Aabb& box : frames_[0]) scene_.world = merged(scene_.world, box);
  }

  [[nodiscard]] const SceneInfo& scene() const { return scene_; }

  /// Throws InputError (parameters) and UnsupportedError.
  void add(std::string name, Case entered) {
    Contestant added = {
        std::move(name),
        std::make_unique<CaseRun>(std::move(entered), RunPolicy::unlimited(CheckMode::off)),
        {}};
    added.run->start(scene_, {0, frames_[0]});
    requireRunning(added);
    contestants_.push_back(std::move(added));
  }

  void run(int rounds) {
    for (int round = -1; round < rounds; ++round) {  // the first one warms up
      const auto index = static_cast<std::uint32_t>(round + 2);
      for (Contestant& contestant : contestants_) {
        contestant.run->step({index, boxesOf(index)});
        requireRunning(contestant);
        if (round < 0) continue;
        const std::int64_t ns = contestant.run->times()[Phase::total];
        contestant.milliseconds.push_back(static_cast<double>(ns) * 1e-6);
      }
    }
  }

  [[nodiscard]] const Contestant& find(std::string_view name) const {
    return *std::ranges::find(contestants_, name, &Contestant::name);
  }

  /// Time of `a` / time of `b`: the median of the rounds' ratios.
  [[nodiscard]] double ratio(std::string_view a, std::string_view b) const {
    const std::vector<double>& of_a = find(a).milliseconds;
    const std::vector<double>& of_b = find(b).milliseconds;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < of_a.size(); ++i) ratios.push_back(of_a[i] / of_b[i]);
    return quantile(ratios, 0.5);
  }

 private:
  static void requireRunning(const Contestant& contestant) {
    const CaseRun& run = *contestant.run;
    if (run.running()) return;
    if (run.status() == Status::unsupported) throw UnsupportedError(run.reason());
    throw std::runtime_error(contestant.name + ": " + run.reason());
  }

  [[nodiscard]] std::span<const Aabb> boxesOf(std::uint32_t index) const {
    const std::size_t last = frames_.size() - 1;
    if (last == 0) return frames_[0];
    const std::size_t way = index % (2 * last);
    return frames_[way <= last ? way : 2 * last - way];
  }

  SceneInfo scene_;
  std::span<const std::vector<Aabb>> frames_;
  std::vector<Contestant> contestants_;
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
