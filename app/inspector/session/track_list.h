// The inspected algorithms: their cases, and the track of the shown answer.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/harness/case.h"
#include "inspector/run/algorithm_track.h"
#include "request/cases.h"

namespace broadmark {

/// A track being edited. applyEdits() copies the parameters to its case, which is run.
struct TrackEdit : TrackSpec {
  std::unique_ptr<BroadPhase> parameters;  ///< edited parameter values; never run
};

class TrackList {
 public:
  /// `algorithms`: the available ones.
  explicit TrackList(std::vector<Algorithm> algorithms) : algorithms_(std::move(algorithms)) {}

  [[nodiscard]] const std::vector<Algorithm>& algorithms() const { return algorithms_; }

  /// Adds an algorithm with its default parameters. Throws InputError for an unknown id.
  TrackEdit& add(const std::string& algorithm_id) {
    return add(
        makeCase(requireAlgorithm(algorithm_id, algorithms_), bestIsa(), allCores(), {}, {}));
  }

  /// Adds a case. Throws InputError for invalid parameters.
  TrackEdit& add(const Case& test_case) {
    list.push_back({{.number = last_number_ + 1, .test_case = test_case}, makeInstance(test_case)});
    ++last_number_;
    if (list.size() == 1) shown_ = last_number_;
    applyEdits();
    return list.back();
  }

  void remove(int number) {
    std::erase_if(list, [&](const TrackEdit& edit) { return edit.number == number; });
    if (shown_ == number) shown_ = list.empty() ? 0 : list.front().number;
    applyEdits();
  }

  void clear() {
    list.clear();
    shown_ = 0;
    applyEdits();
  }

  /// Call after editing tracks: copies their parameters to the cases.
  void applyEdits() {
    for (TrackEdit& track : list) {
      Case& test_case = track.test_case;
      ParameterValues values =
          changedValues(parameterValues(*track.parameters), *test_case.algorithm.create());
      test_case = makeCase(test_case.algorithm, test_case.isa, test_case.threads, test_case.device,
                           std::move(values), test_case.answer);
    }
    on_change();
  }

  /// Replaces the algorithms of a plug-in, or adds them. Its tracks get the new ones, with the
  /// parameters that these still have; a track without one is removed.
  void replaceAlgorithms(const std::string& plugin, const std::vector<Algorithm>& algorithms) {
    const auto is_its = [&](const Algorithm& algorithm) { return algorithm.plugin == plugin; };
    std::erase_if(algorithms_, is_its);
    algorithms_.insert(algorithms_.end(), algorithms.begin(), algorithms.end());
    std::erase_if(list, [&](const TrackEdit& track) {
      const Algorithm& algorithm = track.test_case.algorithm;
      return is_its(algorithm) && findAlgorithm(algorithm.id, algorithms) == nullptr;
    });
    for (TrackEdit& track : list) {
      Algorithm& algorithm = track.test_case.algorithm;
      if (!is_its(algorithm)) continue;
      algorithm = *findAlgorithm(algorithm.id, algorithms);
      track.parameters = algorithm.create();
      ++track.build;
      for (const auto& value : track.test_case.parameters) {
        try {
          setParameters(*track.parameters, {value});
        } catch (const InputError&) {  // NOLINT(bugprone-empty-catch): the default remains
        }
      }
    }
    if (shown_ != 0 && find(shown_) == nullptr) shown_ = list.empty() ? 0 : list.front().number;
    applyEdits();
  }

  /// Returns the track with this number, or null.
  [[nodiscard]] TrackEdit* find(int number) {
    const auto found = std::ranges::find(list, number, &TrackEdit::number);
    return found == list.end() ? nullptr : &*found;
  }

  /// Number of the track with the shown answer; 0: the oracle's.
  [[nodiscard]] int shown() const { return shown_; }
  void show(int number) { shown_ = number; }

  /// The tracks to run.
  [[nodiscard]] std::vector<TrackSpec> specs() const { return {list.begin(), list.end()}; }

  std::vector<TrackEdit> list;
  std::function<void()> on_change;  ///< set by the owner

 private:
  std::vector<Algorithm> algorithms_;
  int shown_ = 0;
  int last_number_ = 0;
};

}  // namespace broadmark
