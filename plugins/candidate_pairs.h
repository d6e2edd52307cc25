// The pairs of a library that compares other boxes than the bodies' own: rounded or enlarged ones.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "broadmark/broad_phase.h"
#include "broadmark/pair_set.h"

namespace broadmark {

/// The library's pairs are candidates. A pair begins when it becomes a candidate, or when the boxes
/// of a candidate start to overlap; it ends in the same way. So the answer is exact.
class CandidatePairs {
 public:
  void clearEvents() {
    began_.clear();
    ended_.clear();
  }

  [[nodiscard]] bool contains(Pair pair) const {
    return overlapping_.contains(pair) || separated_.contains(pair);
  }

  /// Adds candidates, of which none is known; update() tests them.
  void insert(PairRun pairs) { separated_.insert(pairs); }

  /// Removes a candidate.
  void drop(Pair pair) {
    if (overlapping_.contains(pair)) {
      overlapping_.erase(PairRun(&pair, 1));
      ended_.add(pair.a, pair.b);
    } else {
      separated_.erase(PairRun(&pair, 1));
    }
  }

  /// Removes the candidates for which is_over(pair).
  template <class Predicate>
  void dropIf(Predicate is_over) {
    select(overlapping_, is_over);
    overlapping_.erase(selected_);
    for (const Pair pair : selected_) ended_.add(pair.a, pair.b);
    select(separated_, is_over);
    separated_.erase(selected_);
  }

  /// Tests the candidates with a body that moved, and sets the answer.
  template <class HasMoved, class Overlap>
  void update(ThreadTeam& team, HasMoved has_moved, Overlap overlap) {
    const PairRun pairs = overlapping_.run();
    ended_by_worker_.resize(static_cast<std::size_t>(team.size()));
    team.run(pairs.size(), [&](int worker, Range part) {
      PairBuffer& ended = ended_by_worker_[static_cast<std::size_t>(worker)];
      ended.clear();
      for (const Pair pair : pairs.subspan(part.begin, part.size())) {
        if (has_moved(pair) && !overlap(pair)) ended.add(pair.a, pair.b);
      }
    });
    for (const PairBuffer& ended : ended_by_worker_) {
      overlapping_.erase(ended.run());
      for (const Pair pair : ended.run()) ended_.add(pair.a, pair.b);
    }
    select(separated_, [&](Pair pair) { return has_moved(pair) && overlap(pair); });
    separated_.erase(selected_);
    overlapping_.insert(selected_);
    for (const Pair pair : selected_) began_.add(pair.a, pair.b);
    for (const PairBuffer& ended : ended_by_worker_) separated_.insert(ended.run());
  }

  /// Sets the answer: to be called at the end of each frame.
  void endFrame() { runs_ = {overlapping_.run(), began_.run(), ended_.run()}; }
  [[nodiscard]] PairRuns overlaps() const { return {runs_.data(), 1}; }
  [[nodiscard]] PairEvents events() const { return {{&runs_[1], 1}, {&runs_[2], 1}}; }

  void visitCounters(const CounterVisitor& visit) const {
    visit("pairs begun", began_.size());
    visit("pairs ended", ended_.size());
    visit("candidates", overlapping_.run().size() + separated_.run().size());
  }

  /// As BroadPhase::validate(), for present bodies.
  template <class ArePresent, class Overlap>
  [[nodiscard]] std::string validate(ArePresent are_present, Overlap overlap) const {
    for (const Pair pair : overlapping_.run()) {
      if (!are_present(pair) || !overlap(pair)) return "a reported pair does not overlap";
    }
    for (const Pair pair : separated_.run()) {
      if (!are_present(pair) || overlap(pair)) return "an overlapping pair is not reported";
    }
    return {};
  }

 private:
  template <class Predicate>
  void select(const PairSet& pairs, Predicate predicate) {
    selected_.clear();
    for (const Pair pair : pairs.run()) {
      if (predicate(pair)) selected_.push_back(pair);
    }
  }

  PairSet overlapping_;
  PairSet separated_;  ///< candidates that do not overlap
  // Of the current frame.
  std::vector<PairBuffer> ended_by_worker_;
  PairBuffer began_;
  PairBuffer ended_;
  std::vector<Pair> selected_;
  std::array<PairRun, 3> runs_;  ///< overlapping, begun, ended
};

}  // namespace broadmark
