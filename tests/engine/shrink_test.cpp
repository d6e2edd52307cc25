// Shrinking of failing cases: planted faults are reproduced by minimal parts.

#include "broadmark/fuzz/shrink.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "broadmark/harness/runner.h"
#include "broadmark/recordings/recording.h"
#include "engine/helpers.h"
#include "support/changing_worlds.h"
#include "support/faulty_algorithm.h"
#include "support/wandering_boxes.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Brute force with a spoilt answer; `spoil` gets the boxes and the number of frames so far.
class Spoilt final : public BoxBroadPhase {
 public:
  using Spoil = std::function<void(std::vector<Pair>&, const std::vector<Aabb>&, int seen)>;
  Spoilt(Spoil spoil, float margin) : spoil_(std::move(spoil)), margin_(margin) {}

  [[nodiscard]] float margin() const override { return margin_; }
  void findPairs() override {
    std::vector<Aabb> fat = boxes();
    for (Aabb& box : fat) box = enlarged(box, margin_);
    std::vector<Pair> answer = bruteForcePairs(fat);
    spoil_(answer, boxes(), ++seen_);
    for (const Pair pair : answer) pairs().add(pair.a, pair.b);
  }

 private:
  Spoil spoil_;
  float margin_;
  int seen_ = 0;
};

Case spoilt(Spoilt::Spoil spoil, float margin = 0) {
  Case test_case;
  test_case.algorithm.id = "spoilt";
  test_case.algorithm.create = [=] { return std::make_unique<Spoilt>(spoil, margin); };
  return test_case;
}

FrameList wandering(std::uint32_t objects, std::uint32_t frames, std::uint64_t seed) {
  WanderingBoxes live(objects, frames, seed);
  return FrameList(live);
}

void dropFirst(std::vector<Pair>& answer) {
  if (!answer.empty()) answer.erase(answer.begin());
}

Case faultyCase(const std::string& id) {
  for (const Algorithm& algorithm : faulty::variants()) {
    if (algorithm.id != id) continue;
    return {.algorithm = algorithm, .parameters = {{"fat_margin", "0.5"}}};  // fails often enough
  }
  throw std::logic_error(id);
}

/// The difference of the first wrong frame.
FrameDifference firstDifference(const Case& test_case, FrameSource& source) {
  const CaseResult result = runCase(test_case, source);
  EXPECT_EQ(result.status, Status::mismatch) << result.reason;
  return result.differences.empty() ? FrameDifference{.frame = 1} : result.differences.front();
}

/// The difference of a new instance in the last frame of a part.
FrameDifference lastDifference(const Case& test_case, IndexedFrames& source,
                               const Selection& part) {
  SubRecording frames(source, part, "Part");
  CaseResult result = runCase(test_case, frames);
  if (result.differences.empty()) return {};
  if (result.differences.back().frame != frames.scene().frames) return {};
  return result.differences.back();
}

std::vector<std::uint32_t> without(std::vector<std::uint32_t> items, std::size_t item) {
  items.erase(items.begin() + static_cast<std::ptrdiff_t>(item));
  return items;
}

/// A part without one of its bodies.
Selection withoutBody(const Selection& part, std::size_t body) {
  Selection fewer = part;
  fewer.bodies = without(part.bodies, body);
  std::vector<std::uint32_t> indices(part.bodies.size());
  std::iota(indices.begin(), indices.end(), 0U);
  fewer.filter = part.filter.of(without(indices, body));
  return fewer;
}

/// Variants of the part with a single absence filled, by the box before or after it.
std::vector<Selection> withAnAbsenceFilled(IndexedFrames& source, const Selection& part) {
  std::vector<Selection> filled;
  SubRecording some(source, part, "Part");
  const FrameList frames(some);
  FrameList list = frames;
  const auto last = static_cast<std::uint32_t>(part.frames.size() - 1);
  for (std::size_t body = 0; body < part.bodies.size(); ++body) {
    const auto box = [&](std::uint32_t index) { return list.at(index).boxes[body]; };
    for (std::uint32_t begin = 0; begin <= last; ++begin) {
      if (!isEmpty(box(begin))) continue;
      std::uint32_t end = begin;
      while (end < last && isEmpty(box(end + 1))) ++end;
      for (const Aabb& filling :
           {begin > 0 ? box(begin - 1) : kEmptyBox, end < last ? box(end + 1) : kEmptyBox}) {
        if (isEmpty(filling)) continue;
        filled.push_back(part);
        filled.back().filled.push_back(
            {part.bodies[body], part.frames[begin], part.frames[end], filling});
      }
      begin = end;
    }
  }
  return filled;
}

/// Variants of the part with a single simplification of its filter.
std::vector<Selection> withASimplerFilter(const Selection& part) {
  std::vector<BodyGroups> groups;
  for (std::uint32_t body = 0; body < part.bodies.size(); ++body) {
    groups.push_back(part.filter.groupsOf(body));
  }
  const LayerMatrix matrix = part.filter.matrix();
  std::vector<Selection> simpler;
  const auto add = [&](const std::vector<BodyGroups>& changed, const LayerMatrix& other) {
    Selection variant = part;
    variant.filter = CollisionFilter(changed, other);
    if (variant.filter != part.filter) simpler.push_back(variant);
  };
  const auto change_all = [&](const auto& change) {
    std::vector<BodyGroups> changed = groups;
    for (BodyGroups& body : changed) change(body);
    add(changed, matrix);
  };
  for (const BodyGroups& from : groups) {
    for (const BodyGroups& to : groups) {
      change_all([&](BodyGroups& body) {
        if (body.layer == from.layer) body.layer = to.layer;
      });
      LayerMatrix more = matrix;
      add(groups, more.set(from.layer, to.layer));
    }
    change_all([&](BodyGroups& body) {
      if (body.world == from.world) body.world = groups.front().world;
    });
    for (const std::uint32_t gone : from.tags) {
      change_all([&](BodyGroups& body) {
        for (std::uint32_t& tag : body.tags) {
          if (tag == gone) tag = BodyGroups::kNoTag;
        }
      });
    }
  }
  return simpler;
}

/// Expects that the part fails in its last frame, and that no smaller part does.
void expectMinimal(const Case& test_case, IndexedFrames& source, const ShrunkCase& shrunk) {
  EXPECT_TRUE(shrunk.minimal);
  const Selection& part = shrunk.part;
  EXPECT_TRUE(std::ranges::is_sorted(part.bodies));
  EXPECT_TRUE(std::ranges::is_sorted(part.frames));
  const FrameDifference difference = lastDifference(test_case, source, part);
  EXPECT_TRUE(difference.isMismatch());
  EXPECT_EQ(difference.missed_pairs, shrunk.difference.missed_pairs);
  EXPECT_EQ(difference.false_pairs, shrunk.difference.false_pairs);
  const auto fails = [&](const Selection& fewer) {
    return lastDifference(test_case, source, fewer).isMismatch();
  };
  for (std::size_t i = 0; i < part.bodies.size(); ++i) {
    EXPECT_FALSE(fails(withoutBody(part, i))) << "without body " << i;
  }
  for (std::size_t i = 0; i + 1 < part.frames.size() && part.frames.size() > 2; ++i) {
    Selection fewer = part;
    fewer.frames = without(part.frames, i);
    EXPECT_FALSE(fails(fewer)) << "without frame " << i;
  }
  for (const Selection& filled : withAnAbsenceFilled(source, part)) {
    EXPECT_FALSE(fails(filled)) << "body " << filled.filled.back().body << " present";
  }
  for (const Selection& simpler : withASimplerFilter(part)) EXPECT_FALSE(fails(simpler));
}

class PlantedFault : public testing::TestWithParam<std::uint64_t> {
 protected:
  FrameList scene_ = wandering(200, 400, GetParam());
};
INSTANTIATE_TEST_SUITE_P(Seeds, PlantedFault, testing::Values(1, 2, 3, 4, 5, 6));

TEST_P(PlantedFault, MissedPairNeedsThreeBodiesAndTwoFrames) {
  const Case test_case = faultyCase("faulty");
  const FrameDifference known = firstDifference(test_case, scene_);
  const ShrunkCase shrunk = shrinkCase(test_case, scene_, known);
  expectMinimal(test_case, scene_, shrunk);
  EXPECT_EQ(shrunk.part.bodies.size(), 3U);
  EXPECT_LE(shrunk.part.frames.size(), 3U);  // a pose and two frames
  EXPECT_EQ(shrunk.part.frames.back(), known.frame);
  EXPECT_EQ(shrunk.difference.missed_count, 1U);
  EXPECT_EQ(shrunk.difference.false_count + shrunk.difference.invalid_count, 0U);
}

TEST_P(PlantedFault, FalsePairNeedsTwoBodies) {
  const Case test_case = faultyCase("faulty-extra");
  const FrameDifference known = firstDifference(test_case, scene_);
  const ShrunkCase shrunk = shrinkCase(test_case, scene_, known);
  EXPECT_EQ(shrunk.part.bodies.size(), 2U);
  EXPECT_EQ(shrunk.part.frames.size(), 2U);
  EXPECT_EQ(shrunk.difference.false_count, 1U);
  EXPECT_EQ(shrunk.difference.missed_count + shrunk.difference.invalid_count, 0U);
  expectMinimal(test_case, scene_, shrunk);
}

TEST_P(PlantedFault, SameInputSameResult) {
  const Case test_case = faultyCase("faulty");
  const FrameDifference known = firstDifference(test_case, scene_);
  const ShrunkCase first = shrinkCase(test_case, scene_, known);
  const ShrunkCase second = shrinkCase(test_case, scene_, known);
  EXPECT_EQ(first.part, second.part);
  EXPECT_EQ(first.trials, second.trials);
}

TEST_P(PlantedFault, IsFoundWithoutKnowingThePairAndWithLittleMemory) {
  const Case test_case = faultyCase("faulty");
  const FrameDifference known = firstDifference(test_case, scene_);
  const FrameDifference only_frame{.frame = known.frame};
  for (const std::size_t memory : {std::size_t{0}, std::size_t{20'000}, std::size_t{1} << 30}) {
    const ShrunkCase shrunk = shrinkCase(test_case, scene_, only_frame, {.memory_bytes = memory});
    EXPECT_EQ(shrunk.part.bodies.size(), 3U);
    EXPECT_LE(shrunk.part.frames.size(), 3U);  // a pose and two frames
    expectMinimal(test_case, scene_, shrunk);
  }
}

TEST(Shrink, ParametersCount) {
  FrameList scene = wandering(200, 400, 1);
  Case test_case = faultyCase("faulty");
  test_case.parameters = {{"fat_margin", "0.3"}};
  const FrameDifference known = firstDifference(test_case, scene);
  const ShrunkCase shrunk = shrinkCase(test_case, scene, known);
  EXPECT_EQ(shrunk.part.bodies.size(), 3U);
  expectMinimal(test_case, scene, shrunk);
  test_case.parameters = {{"fat_margin", "900"}};  // nothing ever moves
  EXPECT_THAT(inputErrorOf([&] { shrinkCase(test_case, scene, known); }),
              HasSubstr("does not fail"));
}

TEST(Shrink, CancelledKeepsTheBestSoFar) {
  FrameList scene = wandering(200, 400, 1);
  const Case test_case = faultyCase("faulty");
  const FrameDifference known = firstDifference(test_case, scene);
  const std::uint64_t all = shrinkCase(test_case, scene, known).trials;
  for (const std::uint64_t enough : {std::uint64_t{0}, std::uint64_t{1}, all / 2, all - 1}) {
    std::uint64_t done = 0;
    std::size_t bodies = 200;
    const ShrunkCase shrunk = shrinkCase(test_case, scene, known,
                                         {.progress =
                                              [&](const ShrinkProgress& now) {
                                                EXPECT_EQ(now.trials, ++done);
                                                EXPECT_LE(now.bodies, bodies);
                                                bodies = now.bodies;
                                              },
                                          .cancelled = [&] { return done >= enough; }});
    EXPECT_EQ(shrunk.trials, enough);
    EXPECT_FALSE(shrunk.minimal);
    EXPECT_EQ(shrunk.part.bodies.size(), bodies);
    EXPECT_TRUE(lastDifference(test_case, scene, shrunk.part).isMismatch());
  }
}

TEST(Shrink, FaultsOfManyBodiesKeepThemAll) {
  constexpr std::size_t kNeeded = 37;
  const Case test_case = spoilt([](std::vector<Pair>& answer, const std::vector<Aabb>& boxes, int) {
    if (boxes.size() >= kNeeded) dropFirst(answer);
  });
  FrameList scene = wandering(90, 12, 1);
  for (const std::size_t memory : {std::size_t{1000}, std::size_t{1} << 30}) {
    const ShrunkCase shrunk = shrinkCase(test_case, scene, {.frame = 12}, {.memory_bytes = memory});
    EXPECT_EQ(shrunk.part.bodies.size(), kNeeded);
    EXPECT_EQ(shrunk.part.frames.size(), 2U);
    expectMinimal(test_case, scene, shrunk);
  }
}

TEST(Shrink, FaultsOfLongHistoriesKeepThem) {
  const Case test_case = spoilt([](std::vector<Pair>& answer, const std::vector<Aabb>&, int seen) {
    if (seen == 7) dropFirst(answer);
  });
  FrameList scene = wandering(60, 20, 1);
  EXPECT_THAT(inputErrorOf([&] { shrinkCase(test_case, scene, {.frame = 20}); }),
              AllOf(HasSubstr("Wandering"), HasSubstr("spoilt"), HasSubstr("frame 20")));
  const ShrunkCase shrunk = shrinkCase(test_case, scene, firstDifference(test_case, scene));
  EXPECT_EQ(shrunk.part.bodies.size(), 2U);
  EXPECT_EQ(shrunk.part.frames.size(), 8U);
  expectMinimal(test_case, scene, shrunk);
}

TEST(Shrink, PairsWithinTheMarginAreNoFault) {
  constexpr float kMargin = 0.2F;
  // A false pair beyond the margin: of the first and the last body.
  const Case test_case = spoilt(
      [](std::vector<Pair>& answer, const std::vector<Aabb>& boxes, int) {
        const Pair far{0, static_cast<std::uint32_t>(boxes.size() - 1)};
        if (boxes.size() < 4 || std::ranges::count(answer, far) > 0) return;
        answer.push_back(far);
      },
      kMargin);
  FrameList scene = wandering(80, 5, 1);
  const FrameDifference known = firstDifference(test_case, scene);
  ASSERT_GT(known.allowed_extra_count, 0U);
  const ShrunkCase shrunk = shrinkCase(test_case, scene, known);
  EXPECT_EQ(shrunk.part.bodies.size(), 4U);
  EXPECT_EQ(shrunk.difference.false_count, 1U);
  expectMinimal(test_case, scene, shrunk);
}

TEST(Shrink, AnswersThatAreNoPairsAreFaults) {
  const Case test_case = spoilt([](std::vector<Pair>& answer, const std::vector<Aabb>& boxes, int) {
    if (boxes.size() > 2) answer.push_back({2, 2});
  });
  FrameList scene = wandering(30, 3, 1);
  const ShrunkCase shrunk = shrinkCase(test_case, scene, firstDifference(test_case, scene));
  EXPECT_EQ(shrunk.part.bodies.size(), 3U);
  EXPECT_EQ(shrunk.difference.invalid_count, 1U);
  expectMinimal(test_case, scene, shrunk);
}

TEST(Shrink, WhatThrowsDoesNotFail) {
  const Case test_case = spoilt([](std::vector<Pair>& answer, const std::vector<Aabb>& boxes, int) {
    if (boxes.size() < 5) throw std::runtime_error("too few");
    dropFirst(answer);
  });
  FrameList scene = wandering(50, 4, 1);
  const ShrunkCase shrunk = shrinkCase(test_case, scene, firstDifference(test_case, scene));
  EXPECT_EQ(shrunk.part.bodies.size(), 5U);
}

TEST(Shrink, ManyBodiesTakeFewTrials) {
  const std::uint32_t n = kSanitized ? 5'000 : 20'000;
  // A sweep that loses the lowest pair if there are three or more bodies.
  Case test_case;
  test_case.algorithm.id = "sweep";
  test_case.algorithm.create = [] {
    class Sweep final : public BoxBroadPhase {
      void findPairs() override {
        std::vector<Pair> answer = sweptPairs(boxes());
        if (boxes().size() > 2) dropFirst(answer);
        for (const Pair pair : answer) pairs().add(pair.a, pair.b);
      }
    };
    return std::make_unique<Sweep>();
  };
  FrameList scene = wandering(n, 6, 1);
  const ShrunkCase shrunk = shrinkCase(test_case, scene, {.frame = 6});
  EXPECT_EQ(shrunk.part.bodies.size(), 3U);
  EXPECT_EQ(shrunk.part.frames.size(), 2U);
  EXPECT_LT(shrunk.trials, 30U);
}

TEST(Shrink, WhatCannotBeShrunk) {
  FrameList scene = wandering(20, 3, 1);
  const Case right = spoilt([](std::vector<Pair>&, const std::vector<Aabb>&, int) {});
  EXPECT_THAT(inputErrorOf([&] { shrinkCase(right, scene, {.frame = 2}); }),
              HasSubstr("does not fail in frame 2"));
  // Also with missed pairs in the difference.
  const FrameDifference wrong{.frame = 2, .missed_count = 1, .missed_pairs = {{3, 99}, {4, 5}}};
  EXPECT_THAT(inputErrorOf([&] { shrinkCase(right, scene, wrong); }),
              HasSubstr("does not fail in frame 2"));
  for (const std::uint32_t frame : {0U, 4U}) {
    EXPECT_THAT(inputErrorOf([&] { shrinkCase(right, scene, {.frame = frame}); }),
                HasSubstr("frames 1 to 3"));
  }
  Case check = right;
  check.algorithm.traits.finds_pairs = false;
  EXPECT_THAT(inputErrorOf([&] { shrinkCase(check, scene, {.frame = 2}); }),
              HasSubstr("finds no pairs"));
  Case bad = right;
  bad.parameters = {{"nonsense", "1"}};
  EXPECT_THAT(inputErrorOf([&] { shrinkCase(bad, scene, {.frame = 2}); }), HasSubstr("nonsense"));
}

/// Brute force in changing worlds with a spoilt answer; `spoil` also gets the boxes of the previous
/// frame.
class SpoiltInChangingWorlds final : public BoxBroadPhase {
 public:
  struct Seen {
    const SceneInfo& scene;
    std::span<const Aabb> boxes;
    std::span<const Aabb> before;  ///< equal to `boxes` in the first frame
  };
  using Spoil = std::function<void(std::vector<Pair>&, const Seen&)>;

  explicit SpoiltInChangingWorlds(Spoil spoil) : spoil_(std::move(spoil)) {}

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    scene_ = scene;
    before_ = boxes();
  }
  void findPairs() override {
    std::vector<Pair> answer = bruteForcePairs(boxes(), scene_.filter);
    spoil_(answer, {scene_, boxes(), before_});
    for (const Pair pair : answer) pairs().add(pair.a, pair.b);
    before_ = boxes();
  }

 private:
  Spoil spoil_;
  SceneInfo scene_;
  std::vector<Aabb> before_;
};

Case spoiltInChangingWorlds(SpoiltInChangingWorlds::Spoil spoil) {
  Case test_case;
  test_case.algorithm.id = "spoilt";
  test_case.algorithm.traits.changing_worlds = ChangingWorlds::native;
  test_case.algorithm.create = [=] { return std::make_unique<SpoiltInChangingWorlds>(spoil); };
  return test_case;
}

/// Whether a body has appeared or vanished since the previous frame.
bool hasChangedPopulation(const SpoiltInChangingWorlds::Seen& seen, bool appeared) {
  for (std::size_t body = 0; body < seen.boxes.size(); ++body) {
    const Aabb& empty = appeared ? seen.before[body] : seen.boxes[body];
    const Aabb& full = appeared ? seen.boxes[body] : seen.before[body];
    if (isEmpty(empty) && !isEmpty(full)) return true;
  }
  return false;
}

/// Bodies that appear and vanish, with layers, worlds and tags.
FrameList changingScene() {
  WanderingBoxes live(60, 12, 1);
  return changing(live, presences::random, filters(60).back().filter);
}

std::size_t absencesIn(IndexedFrames& source, const Selection& part) {
  SubRecording frames(source, part, "Part");
  std::size_t absent = 0;
  recordAll(frames, [&](const Frame& frame) {
    absent += static_cast<std::size_t>(std::ranges::count_if(frame.boxes, isEmpty));
  });
  return absent;
}

TEST(ShrinkInChangingWorlds, AFaultThatNeedsOneRemoval) {
  FrameList scene = changingScene();
  for (const bool appeared : {false, true}) {
    SCOPED_TRACE(appeared);
    const Case test_case = spoiltInChangingWorlds([=](std::vector<Pair>& answer, const auto& seen) {
      if (hasChangedPopulation(seen, appeared)) dropFirst(answer);
    });
    const ShrunkCase shrunk = shrinkCase(test_case, scene, firstDifference(test_case, scene));
    EXPECT_LE(shrunk.part.bodies.size(), 3U);  // a pair, and a body that appears or vanishes
    EXPECT_EQ(shrunk.part.frames.size(), 2U);
    EXPECT_EQ(absencesIn(scene, shrunk.part), 1U);
    EXPECT_FALSE(shrunk.part.all_present);
    EXPECT_TRUE(shrunk.part.filter.wantsAll());
    expectMinimal(test_case, scene, shrunk);
  }
}

TEST(ShrinkInChangingWorlds, AFaultThatNeedsNoRemovalKeepsNone) {
  const Case test_case =
      spoiltInChangingWorlds([](std::vector<Pair>& answer, const auto&) { dropFirst(answer); });
  FrameList scene = changingScene();
  const ShrunkCase shrunk = shrinkCase(test_case, scene, firstDifference(test_case, scene));
  EXPECT_EQ(shrunk.part.bodies.size(), 2U);
  EXPECT_EQ(shrunk.part.frames.size(), 2U);
  EXPECT_EQ(absencesIn(scene, shrunk.part), 0U);
  EXPECT_TRUE(shrunk.part.all_present);
  EXPECT_TRUE(shrunk.part.filter.wantsAll());
  expectMinimal(test_case, scene, shrunk);
}

TEST(ShrinkInChangingWorlds, ThatSomebodyMayBeAbsentIsEnough) {
  const Case test_case = spoiltInChangingWorlds([](std::vector<Pair>& answer, const auto& seen) {
    if (!seen.scene.all_present) dropFirst(answer);
  });
  FrameList scene = changingScene();
  const ShrunkCase shrunk = shrinkCase(test_case, scene, firstDifference(test_case, scene));
  EXPECT_EQ(shrunk.part.bodies.size(), 2U);
  EXPECT_EQ(absencesIn(scene, shrunk.part), 0U);
  EXPECT_FALSE(shrunk.part.all_present);
  expectMinimal(test_case, scene, shrunk);
}

TEST(ShrinkInChangingWorlds, AFaultThatNeedsTwoLayers) {
  const Case test_case = spoiltInChangingWorlds([](std::vector<Pair>& answer, const auto& seen) {
    std::erase_if(answer, [&](const Pair pair) {
      const CollisionFilter& filter = seen.scene.filter;
      return filter.groupsOf(pair.a).layer != filter.groupsOf(pair.b).layer;
    });
  });
  FrameList scene = changingScene();
  const ShrunkCase shrunk = shrinkCase(test_case, scene, firstDifference(test_case, scene));
  EXPECT_EQ(shrunk.part.bodies.size(), 2U);
  EXPECT_TRUE(shrunk.part.all_present);
  const CollisionFilter& filter = shrunk.part.filter;
  EXPECT_NE(filter.groupsOf(0).layer, filter.groupsOf(1).layer);
  LayerMatrix both;
  for (const std::uint8_t a : filter.layers()) {
    for (const std::uint8_t b : filter.layers()) both.set(a, b);
  }
  EXPECT_EQ(filter.matrix(), both);
  EXPECT_TRUE(filter.worlds().empty());
  EXPECT_TRUE(filter.tags().empty());
  expectMinimal(test_case, scene, shrunk);
}

/// Reports pairs that only one criterion of the filter excludes; the shrunk filter has only that.
TEST(ShrinkInChangingWorlds, FaultsThatNeedLayersApartWorldsOrTags) {
  enum class Criterion { layers, worlds, tags };
  for (const Criterion criterion : {Criterion::layers, Criterion::worlds, Criterion::tags}) {
    SCOPED_TRACE(static_cast<int>(criterion));
    const Case test_case = spoiltInChangingWorlds([=](std::vector<Pair>& answer, const auto& seen) {
      std::vector<BodyGroups> groups;
      for (std::uint32_t body = 0; body < seen.boxes.size(); ++body) {
        groups.push_back(seen.scene.filter.groupsOf(body));
        if (criterion == Criterion::worlds) groups.back().world = 0;
        if (criterion == Criterion::tags) groups.back().tags = BodyGroups::kNoTags;
      }
      const LayerMatrix matrix =
          criterion == Criterion::layers ? LayerMatrix::all() : seen.scene.filter.matrix();
      answer = bruteForcePairs(seen.boxes, CollisionFilter(groups, matrix));
    });
    FrameList scene = changingScene();
    const ShrunkCase shrunk = shrinkCase(test_case, scene, firstDifference(test_case, scene));
    const CollisionFilter& filter = shrunk.part.filter;
    EXPECT_EQ(shrunk.part.bodies.size(), 2U);
    EXPECT_TRUE(shrunk.part.all_present);
    EXPECT_FALSE(filter.wanted(0, 1));
    EXPECT_EQ(!filter.worlds().empty(), criterion == Criterion::worlds);
    EXPECT_EQ(!filter.tags().empty(), criterion == Criterion::tags);
    expectMinimal(test_case, scene, shrunk);
  }
}

TEST(ShrinkInChangingWorlds, IsFoundWithoutKnowingThePairAndWithLittleMemory) {
  const Case test_case = spoiltInChangingWorlds([](std::vector<Pair>& answer, const auto& seen) {
    if (hasChangedPopulation(seen, false)) dropFirst(answer);
  });
  FrameList scene = changingScene();
  const FrameDifference only_frame{.frame = firstDifference(test_case, scene).frame};
  for (const std::size_t memory : {std::size_t{0}, std::size_t{2'000}, std::size_t{1} << 30}) {
    const ShrunkCase shrunk = shrinkCase(test_case, scene, only_frame, {.memory_bytes = memory});
    EXPECT_EQ(absencesIn(scene, shrunk.part), 1U);
    expectMinimal(test_case, scene, shrunk);
  }
}

TEST(Shrink, PartsAreWrittenAsRecordings) {
  const TemporaryDirectory directory;
  FrameList scene = wandering(30, 6, 1);
  const Selection part{{2, 3, 29}, {0, 4, 6}};
  const std::string hash = writeSelection(directory / "part.aabbs", scene, part);
  RecordingReader reader(directory / "part.aabbs");
  EXPECT_EQ(reader.hash(), hash);
  EXPECT_EQ(reader.scene().name, "Wandering case");
  EXPECT_EQ(reader.scene().world, scene.scene().world);
  for (std::uint32_t frame = 0; frame < 3; ++frame) {
    const auto boxes = scene.at(part.frames[frame]).boxes;
    for (std::size_t body = 0; body < 3; ++body) {
      EXPECT_EQ(reader.at(frame).boxes[body], boxes[part.bodies[body]]);
    }
  }
}

TEST(Shrink, NamesOfPartsFitIntoAHeader) {
  EXPECT_EQ(partName({.name = "FreeFall"}), "FreeFall case");
  EXPECT_EQ(partName({.name = "FreeFall case"}), "FreeFall case");
  const std::string shortened = std::string(kMaxNameLength - 5, 'x').append(" case");
  EXPECT_EQ(partName({.name = std::string(kMaxNameLength, 'x')}), shortened);
}

}  // namespace
}  // namespace broadmark::tests
