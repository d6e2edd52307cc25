// The algorithms in the list: how each is run, and whose answer is shown.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/harness/case.h"
#include "inspector/run/lane.h"

namespace broadmark {

/// An algorithm in the list, as it is edited. What runs is the case made from it.
struct LaneEdit {
  int number = 0;
  Algorithm algorithm;
  std::unique_ptr<BroadPhase> parameters;  ///< holds their values; never run
  Isa isa = bestIsa();
  int threads = 1;
  std::string device = {};
  AnswerKind answer = AnswerKind::pairs;

  [[nodiscard]] LaneSpec spec() const;
};

class Lanes {
 public:
  /// `algorithms`: those that can be chosen.
  explicit Lanes(std::vector<Algorithm> algorithms) : algorithms_(std::move(algorithms)) {}

  [[nodiscard]] const std::vector<Algorithm>& algorithms() const { return algorithms_; }

  /// Adds an algorithm with its default parameters. Throws InputError for an unknown id.
  LaneEdit& add(const std::string& algorithm_id);
  LaneEdit& add(const Case& run);
  void remove(int number);
  void clear();
  /// To be called after a lane was edited.
  void changed();
  /// Null if there is none of this number.
  [[nodiscard]] LaneEdit* find(int number);

  /// The lane whose answer is shown, by number; 0: the oracle's.
  [[nodiscard]] int shown() const { return shown_; }
  void show(int number) { shown_ = number; }

  /// What is to run.
  [[nodiscard]] const std::vector<LaneSpec>& specs() const { return specs_; }

  std::vector<LaneEdit> list;
  std::function<void()> on_change;  ///< set by the owner

 private:
  LaneEdit& append(const Algorithm& algorithm);

  std::vector<Algorithm> algorithms_;
  std::vector<LaneSpec> specs_;  ///< of the list when it last changed
  int shown_ = 0;
  int last_number_ = 0;
};

}  // namespace broadmark
