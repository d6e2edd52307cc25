// The algorithms in the list: how each is run, and whose answer is shown.
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
struct LaneEdit : LaneSpec {
  std::unique_ptr<BroadPhase> parameters;  ///< holds their values; never run
};

class Lanes {
 public:
  /// `algorithms`: those that can be chosen.
  explicit Lanes(std::vector<Algorithm> algorithms) : algorithms_(std::move(algorithms)) {}

  [[nodiscard]] const std::vector<Algorithm>& algorithms() const { return algorithms_; }

  /// Adds an algorithm with its default parameters. Throws InputError for an unknown id.
  LaneEdit& add(const std::string& algorithm_id) {
    return add(
        makeCase(requireAlgorithm(algorithm_id, algorithms_), bestIsa(), allCores(), {}, {}));
  }

  /// Throws InputError for bad parameters.
  LaneEdit& add(const Case& run) {
    list.push_back({{.number = last_number_ + 1, .run = run}, makeInstance(run)});
    ++last_number_;
    if (list.size() == 1) shown_ = last_number_;
    changed();
    return list.back();
  }

  void remove(int number) {
    std::erase_if(list, [&](const LaneEdit& edit) { return edit.number == number; });
    if (shown_ == number) shown_ = list.empty() ? 0 : list.front().number;
    changed();
  }

  void clear() {
    list.clear();
    shown_ = 0;
    changed();
  }

  /// To be called after lanes were edited: takes over their parameters.
  void changed() {
    for (LaneEdit& lane : list) {
      Case& run = lane.run;
      ParameterValues values =
          changedValues(parameterValues(*lane.parameters), *run.algorithm.create());
      run =
          makeCase(run.algorithm, run.isa, run.threads, run.device, std::move(values), run.answer);
    }
    on_change();
  }

  /// Null if there is none of this number.
  [[nodiscard]] LaneEdit* find(int number) {
    const auto found = std::ranges::find(list, number, &LaneEdit::number);
    return found == list.end() ? nullptr : &*found;
  }

  /// The lane whose answer is shown, by number; 0: the oracle's.
  [[nodiscard]] int shown() const { return shown_; }
  void show(int number) { shown_ = number; }

  /// What is to run.
  [[nodiscard]] std::vector<LaneSpec> specs() const { return {list.begin(), list.end()}; }

  std::vector<LaneEdit> list;
  std::function<void()> on_change;  ///< set by the owner

 private:
  std::vector<Algorithm> algorithms_;
  int shown_ = 0;
  int last_number_ = 0;
};

}  // namespace broadmark
