// Events derived from pairs, and wrong events, which all checks detect.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "broadmark/adapters.h"
#include "broadmark/change_detector.h"
#include "broadmark/harness/event_accumulator.h"
#include "engine/spoilt_cases.h"
#include "torture/inputs.h"

namespace broadmark::tests {
namespace {

using Pairs = std::vector<Pair>;

constexpr std::uint32_t kBodies = 200;

std::vector<Pair> sortedPairs(PairRuns runs) {
  Pairs pairs;
  for (const PairRun pair_run : runs) pairs.insert(pairs.end(), pair_run.begin(), pair_run.end());
  std::ranges::sort(pairs);
  return pairs;
}

/// Reports a given answer, in runs of several lengths.
class FixedAnswer final : public BroadPhase {
 public:
  explicit FixedAnswer(const Pairs& answer) : answer_(answer) {}

  void initialize(const SceneInfo&, const Frame&, ExecutionContext&) override {}
  void updateObjects(const Frame&) override {}
  void searchOverlaps() override {
    runs_.clear();
    for (std::size_t from = 0, length = 0; from < answer_.size(); from += length++) {
      runs_.push_back(
          PairRun(answer_).subspan(from).first(std::min(length, answer_.size() - from)));
    }
  }
  [[nodiscard]] PairRuns overlaps() const override { return runs_; }

 private:
  const Pairs& answer_;
  std::vector<PairRun> runs_;
};

/// Events of successive answers.
class EventStream {
 public:
  EventStream(int threads, Pairs first)
      : answer_(std::move(first)),
        execution_(threads, Isa::scalar),
        events_(withEvents(std::make_unique<FixedAnswer>(answer_))) {
    events_->initialize({.objects = kBodies}, {0, boxes_, std::span<const std::uint32_t>()},
                        execution_);
  }

  [[nodiscard]] std::pair<Pairs, Pairs> events() const {
    return {sortedPairs(events_->events().began), sortedPairs(events_->events().ended)};
  }
  [[nodiscard]] std::pair<Pairs, Pairs> eventsOf(Pairs answer) {
    answer_ = std::move(answer);
    events_->updateObjects({1, boxes_, std::span<const std::uint32_t>()});
    events_->cleanCache();
    events_->updateStructures();
    events_->searchOverlaps();
    return events();
  }

 private:
  std::vector<Aabb> boxes_ = std::vector<Aabb>(kBodies);
  Pairs answer_;
  ExecutionContext execution_;
  std::unique_ptr<BroadPhase> events_;
};

Pairs without(const std::set<Pair>& pairs, const std::set<Pair>& others) {
  Pairs rest;
  std::ranges::set_difference(pairs, others, std::back_inserter(rest));
  return rest;
}

// Few pairs are compared by one worker, many by all: the pairs of the frame before change owners.
TEST(EventsFromPairs, AreTheDifferencesOfSetsWhateverTheTeam) {
  for (const int threads : {1, 2, 3, 7}) {
    inputs::Random random(1, 1);
    std::set<Pair> before;
    EventStream events(threads, {});
    for (int frame = 0; frame < 40; ++frame) {
      std::set<Pair> now;
      const int max = frame % 5 == 0 ? 0 : 600 * frame;
      for (int i = 0; i < max; ++i) {
        const auto a = static_cast<std::uint32_t>(random.integer(0, kBodies - 2));
        const auto b = static_cast<std::uint32_t>(random.integer(0, kBodies - 2));
        now.insert(orderedPair(a, b >= a ? b + 1 : b));
      }
      Pairs answer(now.begin(), now.end());
      if (frame % 2 == 0) std::ranges::reverse(answer);
      EXPECT_EQ(events.eventsOf(answer), std::pair(without(now, before), without(before, now)));
      before = now;
    }
  }
}

TEST(EventsFromPairs, ThoseOfTheInitialPoseAllBegin) {
  const Pairs first = {{0, 1}, {4, 9}};
  EventStream events(2, first);
  EXPECT_EQ(events.events(), std::pair(first, Pairs()));
  EXPECT_EQ(events.eventsOf(first), std::pair(Pairs(), Pairs()));
}

TEST(EventsFromPairs, FaultsInTheAnswerAreEventsToo) {
  for (const int threads : {1, 3}) {
    EventStream events(threads, {{0, 1}});
    EXPECT_EQ(events.eventsOf({{0, 1}, {0, 1}}).first, (Pairs{{0, 1}})) << "begins twice";
    const Pairs none = {{1, 0}, {2, 2}, {3, kBodies}, {0xFFFF'FFFF, 0xFFFF'FFFF}};
    EXPECT_EQ(events.eventsOf(none), std::pair(none, Pairs{{0, 1}, {0, 1}}));
    EXPECT_EQ(events.eventsOf(none), std::pair(none, Pairs())) << "in every frame";
  }
}

/// Events of brute force; the events of a single frame are spoilt.
class SpoiltEvents final : public BroadPhase {
 public:
  using Spoil = std::function<void(Pairs& began, Pairs& ended)>;
  SpoiltEvents(Spoil spoil, float margin) : spoil_(std::move(spoil)), margin_(margin) {}

  [[nodiscard]] float margin() const override { return margin_; }
  void reportEvents() override { enabled_ = true; }
  void initialize(const SceneInfo&, const Frame& first, ExecutionContext&) override {
    EXPECT_TRUE(enabled_);
    findEvents(first);
  }
  void updateObjects(const Frame& frame) override {
    findEvents(frame);
    if (frame.index == kFaultyFrame) spoil_(began_, ended_);
    runs_ = {PairRun(began_), PairRun(ended_)};
  }
  void searchOverlaps() override {}
  [[nodiscard]] PairRuns overlaps() const override {
    ADD_FAILURE() << "all pairs were queried";
    return {};
  }
  [[nodiscard]] PairEvents events() const override {
    return {{runs_.data(), 1}, {runs_.data() + 1, 1}};
  }

 private:
  void findEvents(const Frame& frame) {
    Pairs now = bruteForcePairs(frame.boxes);
    began_.clear();
    ended_.clear();
    std::ranges::set_difference(now, pairs_, std::back_inserter(began_));
    std::ranges::set_difference(pairs_, now, std::back_inserter(ended_));
    pairs_ = std::move(now);
    runs_ = {PairRun(began_), PairRun(ended_)};
  }

  Spoil spoil_;
  float margin_;
  bool enabled_ = false;
  Pairs pairs_;
  Pairs began_;
  Pairs ended_;
  std::vector<PairRun> runs_;
};

constexpr std::uint32_t kWanderers = 40;

/// Bodies with overlaps that begin and end in every frame.
class Wandering final : public IndexedFrames {
 public:
  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    boxes_ = inputs::teleporting(kWanderers, index, 1);
    return boxes_;
  }

  SceneInfo scene_{"Wandering", "Boxes", kWanderers, 6, {{-9, -9, -9, 0}, {9, 9, 9, 0}}};
  std::vector<Aabb> boxes_;
};

CaseResult resultOf(const SpoiltEvents::Spoil& spoil, CheckMode check, float margin = 0) {
  Case test_case = caseOf({.traits = {.events = true}});
  test_case.answer = AnswerKind::events;
  test_case.algorithm.create = [=] { return std::make_unique<SpoiltEvents>(spoil, margin); };
  Wandering source;
  return runCase(test_case, source, {.check = check});
}

/// Bodies that never overlap.
constexpr Pair kFarApart = {0, 1};

class WrongEvents : public testing::TestWithParam<CheckMode> {};

TEST_P(WrongEvents, AreMismatches) {
  const auto unspoilt = [](Pairs& began, Pairs& ended) {
    EXPECT_FALSE(began.empty());
    EXPECT_FALSE(ended.empty());
  };
  EXPECT_EQ(resultOf(unspoilt, GetParam()).status, Status::ok);
  EXPECT_EQ(resultOf(unspoilt, CheckMode::off).checked, false);
  Wandering source;
  while (const auto frame = source.next()) {
    EXPECT_FALSE(overlaps(frame->boxes[kFarApart.a], frame->boxes[kFarApart.b]));
  }

  const std::map<std::string, SpoiltEvents::Spoil> faults = {
      {"one did not begin", [](Pairs& began, Pairs&) { began.pop_back(); }},
      {"one did not end", [](Pairs&, Pairs& ended) { ended.pop_back(); }},
      {"one began twice", [](Pairs& began, Pairs&) { began.push_back(began.front()); }},
      {"one ended twice", [](Pairs&, Pairs& ended) { ended.push_back(ended.front()); }},
      {"one ended that was not there", [](Pairs&, Pairs& ended) { ended.push_back(kFarApart); }},
      {"one ended and began again",
       [](Pairs& began, Pairs& ended) { began.push_back(ended.front()); }},
      {"one began and ended at once",
       [](Pairs& began, Pairs& ended) {
         began.push_back(kFarApart);
         ended.push_back(kFarApart);
       }},
      {"one with itself", [](Pairs& began, Pairs&) { began.push_back({2, 2}); }},
      {"one the wrong way round", [](Pairs& began, Pairs&) { std::swap(began[0].a, began[0].b); }},
  };
  for (const auto& [name, spoil] : faults) {
    SCOPED_TRACE(name);
    const CaseResult result = resultOf(spoil, GetParam());
    EXPECT_EQ(result.status, Status::mismatch);
    EXPECT_THAT(result.reason, testing::StartsWith("frame 3: "));
    // Also with a margin that allows every extra pair, unless the fault is only an extra pair.
    const bool only_extra = name == "one did not end";
    const CaseResult with_margin = resultOf(spoil, GetParam(), 1000);
    EXPECT_EQ(with_margin.status, only_extra ? Status::ok : Status::mismatch) << with_margin.reason;
  }
}

INSTANTIATE_TEST_SUITE_P(Checks, WrongEvents, testing::Values(CheckMode::full, CheckMode::hash));

TEST(WrongEvents, AWrongAnswerGivesWrongEvents) {
  for (const CheckMode check : {CheckMode::full, CheckMode::hash}) {
    for (const auto& spoil : std::vector<std::function<void(Pairs&)>>{
             [](Pairs& answer) { answer.pop_back(); }, [](Pairs& answer) { answer.clear(); },
             [](Pairs& answer) { answer.push_back({0, 3}); },
             [](Pairs& answer) { answer.push_back(answer.front()); },
             [](Pairs& answer) { answer.push_back({2, 1}); }}) {
      Case test_case = spoilingAnswer(spoil);
      EXPECT_EQ(runOnChain(test_case, {.check = check}).status, Status::mismatch);
      test_case.answer = AnswerKind::events;
      const CaseResult result = runOnChain(test_case, {.check = check});
      EXPECT_EQ(result.status, Status::mismatch);
      EXPECT_THAT(result.reason, testing::StartsWith("frame 3: "));
      EXPECT_EQ(result.answer, AnswerKind::events);
      EXPECT_EQ(result.id, "Chain/Cubes/N4/F6/spoilt/events");
    }
  }
}

TEST(WrongEvents, TheyCountAsPairsOfTheAnswer) {
  Case test_case = caseOf();
  test_case.answer = AnswerKind::events;
  const CaseResult result = runOnChain(test_case);
  EXPECT_EQ(result.status, Status::ok);
  EXPECT_EQ(result.pairs_max, 0U) << "the chain moves as a whole";
  test_case.answer = AnswerKind::pairs;
  EXPECT_EQ(runOnChain(test_case).pairs_max, 3U);
}

}  // namespace
}  // namespace broadmark::tests
