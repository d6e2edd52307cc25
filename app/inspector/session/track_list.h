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

/// An algorithm in the list, as it is edited. What runs is its case.
struct TrackEdit : TrackSpec {
  std::unique_ptr<BroadPhase> parameters;  ///< holds their values; never run
};

class TrackList {
 public:
  /// `algorithms`: those that can be chosen.
  explicit TrackList(std::vector<Algorithm> algorithms) : algorithms_(std::move(algorithms)) {}

  [[nodiscard]] const std::vector<Algorithm>& algorithms() const { return algorithms_; }

  /// Adds an algorithm with its default parameters. Throws InputError for an unknown id.
  TrackEdit& add(const std::string& algorithm_id) {
    return add(
        makeCase(requireAlgorithm(algorithm_id, algorithms_), bestIsa(), allCores(), {}, {}));
  }

  /// Throws InputError for bad parameters.
  TrackEdit& add(const Case& test_case) {
    list.push_back({{.number = last_number_ + 1, .test_case = test_case}, makeInstance(test_case)});
    ++last_number_;
    if (list.size() == 1) shown_ = last_number_;
    changed();
    return list.back();
  }

  void remove(int number) {
    std::erase_if(list, [&](const TrackEdit& edit) { return edit.number == number; });
    if (shown_ == number) shown_ = list.empty() ? 0 : list.front().number;
    changed();
  }

  void clear() {
    list.clear();
    shown_ = 0;
    changed();
  }

  /// To be called after tracks were edited: takes over their parameters.
  void changed() {
    for (TrackEdit& track : list) {
      Case& test_case = track.test_case;
      ParameterValues values =
          changedValues(parameterValues(*track.parameters), *test_case.algorithm.create());
      test_case = makeCase(test_case.algorithm, test_case.isa, test_case.threads, test_case.device,
                           std::move(values), test_case.answer);
    }
    on_change();
  }

  /// Null if there is none of this number.
  [[nodiscard]] TrackEdit* find(int number) {
    const auto found = std::ranges::find(list, number, &TrackEdit::number);
    return found == list.end() ? nullptr : &*found;
  }

  /// Number of the track of the shown answer; 0: the oracle's.
  [[nodiscard]] int shown() const { return shown_; }
  void show(int number) { shown_ = number; }

  /// What is to run.
  [[nodiscard]] std::vector<TrackSpec> specs() const { return {list.begin(), list.end()}; }

  std::vector<TrackEdit> list;
  std::function<void()> on_change;  ///< set by the owner

 private:
  std::vector<Algorithm> algorithms_;
  int shown_ = 0;
  int last_number_ = 0;
};

}  // namespace broadmark
