// Algorithms that take turns, frame by frame, on the same boxes: whatever else slows the machine
// slows all of them, so that ratios of their times mean something.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/algorithms.h"
#include "broadmark/runner.h"
#include "broadmark/statistics.h"

namespace broadmark::benchmarks {

/// An algorithm at work on one scene, with the times of its frames so far.
struct Contestant {
  std::string name;
  std::unique_ptr<Execution> execution;
  std::unique_ptr<BroadPhase> algorithm;
  std::vector<double> milliseconds;

  [[nodiscard]] double median() const { return quantile(milliseconds, 0.5); }
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
  void add(std::string name, const Algorithm& algorithm, Isa isa, int threads,
           const ParameterValues& parameters = {}, const std::string& device = {}) {
    Contestant added = {
        std::move(name), std::make_unique<Execution>(threads, isa, device), algorithm.create(), {}};
    setParameters(*added.algorithm, parameters);
    added.algorithm->initialize(scene_, {0, frames_[0]}, *added.execution);
    contestants_.push_back(std::move(added));
  }

  void run(int rounds) {
    for (int round = -1; round < rounds; ++round) {  // the first one warms up
      const auto index = static_cast<std::uint32_t>(round + 2);
      for (Contestant& contestant : contestants_) {
        const FrameTimes times = runFrame(*contestant.algorithm, {index, boxesOf(index)});
        if (round < 0) continue;
        contestant.milliseconds.push_back(static_cast<double>(times[Phase::total]) * 1e-6);
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

}  // namespace broadmark::benchmarks
