// Several worlds at the same position, with an instance for each: the bodies of each instance, and
// the combined answers.

#include "broadmark/adapters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "broadmark/change_detector.h"
#include "broadmark/harness/case_executor.h"
#include "broadmark/harness/event_accumulator.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/recorded_drawing.h"
#include "support/changing_worlds.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using Boxes = std::vector<Aabb>;
using Pairs = std::vector<Pair>;
using Ids = std::vector<std::uint32_t>;

Pairs concatenated(PairRuns runs) {
  Pairs pairs;
  for (const PairRun pair_run : runs) pairs.insert(pairs.end(), pair_run.begin(), pair_run.end());
  return pairs;
}
Pairs sorted(Pairs pairs) {
  std::ranges::sort(pairs);
  return pairs;
}

/// Finds pairs and events by definition, and records its input.
class Witness final : public BroadPhase {
 public:
  explicit Witness(const Pairs& nonsense) : nonsense_(nonsense) {}

  [[nodiscard]] float margin() const override { return 0.25F; }
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    scene_ = scene;
    threads_ = execution.threads();
    isa_ = execution.isa();
    record(first);
    began_ = pairs_ = bruteForcePairs(boxes_, scene.filter);
  }
  void updateObjects(const Frame& frame) override {
    record(frame);
    phases_ = 1;
  }
  void cleanCache() override { phases_ = phases_ * 10 + 2; }
  void updateStructures() override { phases_ = phases_ * 10 + 3; }
  void searchOverlaps() override {
    phases_ = phases_ * 10 + 4;
    const Pairs before = std::exchange(pairs_, bruteForcePairs(boxes_, scene_.filter));
    began_.clear();
    ended_.clear();
    std::ranges::set_difference(pairs_, before, std::back_inserter(began_));
    std::ranges::set_difference(before, pairs_, std::back_inserter(ended_));
    pairs_.insert(pairs_.end(), nonsense_.begin(), nonsense_.end());
  }
  [[nodiscard]] PairRuns overlaps() const override {
    const PairRun pairs = pairs_;
    runs_ = {pairs.first(pairs.size() / 2), pairs.subspan(pairs.size() / 2)};
    return runs_;
  }
  void reportEvents() override { reports_events_ = true; }
  [[nodiscard]] PairEvents events() const override {
    EXPECT_TRUE(reports_events_);
    began_run_ = began_;
    ended_run_ = ended_;
    return {{&began_run_, 1}, {&ended_run_, 1}};
  }
  [[nodiscard]] TransferTimes transfers() const override { return {1, 2}; }
  void drawStructure(DebugDraw& draw) const override {
    draw.box(boxes_.front(), StructureRole::cell, 0);
  }
  void visitCounters(const CounterVisitor& visit) const override {
    visit("changed", changed_.size());
    visit("bodies", boxes_.size());
  }
  void visitSetup(const CounterVisitor& visit) const override { visit("starts", 1); }
  [[nodiscard]] std::string validate() const override { return fault_; }

  // The recorded input.
  SceneInfo scene_;
  int threads_ = 0;
  Isa isa_ = Isa::avx512;
  std::uint32_t index_ = 0;
  Boxes boxes_;
  Ids changed_;
  int frames_ = -1;  ///< without the initial pose
  int phases_ = 0;   ///< of the last frame: 1234
  std::string fault_;

 private:
  void record(const Frame& frame) {
    index_ = frame.index;
    boxes_.assign(frame.boxes.begin(), frame.boxes.end());
    changed_.assign(frame.changed->begin(), frame.changed->end());
    ++frames_;
  }

  const Pairs& nonsense_;
  bool reports_events_ = false;
  Pairs pairs_;
  Pairs began_;
  Pairs ended_;
  mutable std::vector<PairRun> runs_;
  mutable PairRun began_run_;
  mutable PairRun ended_run_;
};

CollisionFilter worldsOf(const Ids& body_worlds) {
  std::vector<BodyGroups> groups;
  for (const std::uint32_t world : body_worlds) groups.push_back({.world = world});
  return {groups, LayerMatrix().set(0, 0)};
}

Aabb unitAt(float x) { return inputs::boxAt({x, 0, 0}, {1, 1, 1}); }

/// A witness for each world.
class Worlds {
 public:
  struct Options {
    int threads = 1;
    bool concurrent = true;
    bool events = false;
    Pairs nonsense = {};
  };

  Worlds(const CollisionFilter& filter, const Boxes& first, Options options)
      : options_(std::move(options)), execution_(options_.threads, Isa::sse2) {
    SceneInfo scene;
    scene.name = "Worlds";
    scene.objects = static_cast<std::uint32_t>(first.size());
    scene.all_present = false;
    scene.filter = filter;
    worlds_ = perWorld(
        scene,
        [this](const SceneInfo&) {
          auto witness = std::make_unique<Witness>(options_.nonsense);
          witnesses_.push_back(witness.get());
          return witness;
        },
        options_.concurrent);
    if (options_.events) worlds_->reportEvents();
    worlds_->initialize(scene, complete(first), execution_);
  }
  Worlds(const CollisionFilter& filter, const Boxes& first) : Worlds(filter, first, Options()) {}

  void step(const Boxes& boxes) {
    worlds_->updateObjects(complete(boxes));
    worlds_->cleanCache();
    worlds_->updateStructures();
    worlds_->searchOverlaps();
  }

  BroadPhase& all() { return *worlds_; }
  Witness& of(std::size_t world) { return *witnesses_[world]; }
  [[nodiscard]] std::size_t count() const { return witnesses_.size(); }

 private:
  /// The frame's boxes and changes are valid until the next call, as those of any frame.
  Frame complete(const Boxes& boxes) {
    boxes_ = boxes;
    Frame frame = changes_.complete({index_++, boxes_});
    if (!frame.changed) frame.changed.emplace();
    return frame;
  }

  Options options_;
  ExecutionContext execution_;
  std::vector<Witness*> witnesses_;
  std::unique_ptr<BroadPhase> worlds_;
  ChangeDetector changes_;
  Boxes boxes_;
  std::uint32_t index_ = 0;
};

TEST(PerWorldBroadPhase, AreAsManyAsBodiesAreIn) {
  const auto count = [](const CollisionFilter& filter) {
    SceneInfo scene;
    scene.filter = filter;
    return worldCount(scene);
  };
  EXPECT_EQ(count({}), 1U);
  EXPECT_EQ(count(worldsOf({7, 7, 7})), 1U);
  EXPECT_EQ(count(worldsOf({7, 8, 7})), 2U);
  EXPECT_EQ(count(worldsOf({0, 7, 5})), 3U);
}

TEST(PerWorldBroadPhase, ShowEachInstanceItsOwnBodiesOnly) {
  std::vector<BodyGroups> groups = {{.layer = 3, .world = 9},
                                    {.world = 2, .tags = {5, 6, 7}},
                                    {.layer = 1, .world = 9},
                                    {.world = 4},  // a single body: no instance
                                    {.world = 2}};
  const LayerMatrix matrix = LayerMatrix().set(0, 0).set(1, 3);
  Boxes boxes = {unitAt(0), unitAt(1), unitAt(2), unitAt(3), unitAt(4)};
  Worlds worlds({groups, matrix}, boxes);
  ASSERT_EQ(worlds.count(), 2U);
  EXPECT_EQ(worlds.all().margin(), 0.25F);
  const Witness& two = worlds.of(0);
  const Witness& nine = worlds.of(1);
  EXPECT_EQ(two.boxes_, (Boxes{boxes[1], boxes[4]}));
  EXPECT_EQ(nine.boxes_, (Boxes{boxes[0], boxes[2]}));
  for (const Witness* witness : {&two, &nine}) {
    EXPECT_EQ(witness->scene_.name, "Worlds");
    EXPECT_EQ(witness->scene_.objects, 2U);
    EXPECT_FALSE(witness->scene_.all_present);
    EXPECT_EQ(witness->scene_.filter.matrix(), matrix);
    EXPECT_THAT(witness->scene_.filter.worlds(), IsEmpty());
  }
  EXPECT_EQ(two.scene_.filter.groupsOf(0).tags, groups[1].tags);
  EXPECT_EQ(nine.scene_.filter.groupsOf(0).layer, 3);

  boxes[2] = boxes[3] = unitAt(8);
  worlds.step(boxes);
  EXPECT_EQ(nine.boxes_, (Boxes{boxes[0], boxes[2]}));
  EXPECT_THAT(nine.changed_, ElementsAre(1));
  EXPECT_THAT(two.changed_, IsEmpty());
  EXPECT_EQ(nine.phases_, 1234);
}

TEST(PerWorldBroadPhase, OfOneBodyEachHaveNoInstance) {
  Boxes boxes(3, unitAt(0));
  Worlds worlds(worldsOf({1, 2, 3}), boxes);
  boxes[1] = unitAt(1);
  worlds.step(boxes);
  EXPECT_EQ(worlds.count(), 0U);
  EXPECT_THAT(concatenated(worlds.all().overlaps()), IsEmpty());
  EXPECT_EQ(worlds.all().margin(), 0);
}

TEST(PerWorldBroadPhase, InWhichNothingChangesAreNotTouchedAndKeepTheirAnswers) {
  const CollisionFilter filter = worldsOf({0, 0, 1, 1, 2, 2});
  const Boxes first(6, unitAt(0));
  Boxes boxes = first;
  Worlds worlds(filter, boxes);
  worlds.step(boxes);  // processes all worlds: there are no previous answers
  for (std::size_t world = 0; world < 3; ++world) EXPECT_EQ(worlds.of(world).frames_, 1);
  EXPECT_EQ(concatenated(worlds.all().overlaps()), (Pairs{{0, 1}, {2, 3}, {4, 5}}));
  boxes[3] = unitAt(9);
  worlds.step(boxes);
  EXPECT_EQ(concatenated(worlds.all().overlaps()), (Pairs{{0, 1}, {4, 5}}));
  worlds.step(boxes);
  EXPECT_EQ(concatenated(worlds.all().overlaps()), (Pairs{{0, 1}, {4, 5}}));
  boxes[0] = unitAt(0.5F);
  boxes[4] = unitAt(9);
  worlds.step(boxes);
  EXPECT_EQ(concatenated(worlds.all().overlaps()), (Pairs{{0, 1}}));
  EXPECT_EQ(worlds.of(0).frames_, 2);
  EXPECT_EQ(worlds.of(1).frames_, 2);
  EXPECT_EQ(worlds.of(2).frames_, 2);
  // Each instance has consecutive frames: the changes are those since its previous frame.
  EXPECT_EQ(worlds.of(1).index_, 2U);
}

TEST(PerWorldBroadPhase, InWhichNothingChangesHaveNoEvents) {
  Boxes boxes(4, unitAt(0));
  Worlds worlds(worldsOf({0, 1, 0, 1}), boxes, {.events = true});
  EXPECT_EQ(concatenated(worlds.all().events().began), (Pairs{{0, 2}, {1, 3}}));
  worlds.step(boxes);
  EXPECT_EQ(eventCount(worlds.all().events()), 0U);
  boxes[3] = unitAt(9);
  worlds.step(boxes);
  EXPECT_THAT(concatenated(worlds.all().events().began), IsEmpty());
  EXPECT_EQ(concatenated(worlds.all().events().ended), (Pairs{{1, 3}}));
  worlds.step(boxes);
  EXPECT_EQ(eventCount(worlds.all().events()), 0U);
  boxes[0] = unitAt(9);
  boxes[3] = unitAt(0);
  worlds.step(boxes);
  EXPECT_EQ(concatenated(worlds.all().events().began), (Pairs{{1, 3}}));
  EXPECT_EQ(concatenated(worlds.all().events().ended), (Pairs{{0, 2}}));
}

// Some worlds are empty in some frames, or change late; their bodies are interleaved.
TEST(PerWorldBroadPhase, AnswerWithTheScenesOwnIdsWhateverTheTeam) {
  constexpr std::uint32_t kAll = 90;
  constexpr std::uint32_t kWorlds = 7;
  const CollisionFilter filter =
      filterOf(kAll, LayerMatrix().set(0, 0), [](inputs::Random& random, std::uint32_t) {
        return BodyGroups{.world = static_cast<std::uint32_t>(random.integer(0, kWorlds - 1))};
      });
  const auto frames =
      framesWith({"drifting", inputs::drifting}, kAll, 12, [&](auto body, auto frame) {
        const std::uint32_t world = filter.worlds()[body];
        return frame >= world && (frame + world) % 5 != 0;
      });
  for (const int threads : {1, 2, 3, 7, 8}) {
    SCOPED_TRACE(threads);
    Worlds of_pairs(filter, frames[0], {.threads = threads});
    Worlds again(filter, frames[0], {.threads = threads});
    Worlds of_events(filter, frames[0], {.threads = threads, .events = true});
    EventAccumulator followed;
    followed.apply(of_events.all().events(), kAll);
    for (std::size_t frame = 1; frame < frames.size(); ++frame) {
      const Pairs right = bruteForcePairs(frames[frame], filter);
      of_pairs.step(frames[frame]);
      again.step(frames[frame]);
      of_events.step(frames[frame]);
      EXPECT_EQ(sorted(concatenated(of_pairs.all().overlaps())), right);
      EXPECT_EQ(concatenated(again.all().overlaps()), concatenated(of_pairs.all().overlaps()));
      followed.apply(of_events.all().events(), kAll);
      EXPECT_THAT(followed.impossible(), IsEmpty());
      EXPECT_EQ(sorted(concatenated(followed.pairs())), right);
    }
  }
}

// Preserves order and duplicates; invalid ids remain invalid.
TEST(PerWorldBroadPhase, LetWrongPairsBeWrong) {
  const Boxes boxes = {unitAt(0), unitAt(0), unitAt(5), unitAt(9)};
  Worlds worlds(worldsOf({0, 1, 0, 1}), boxes,
                {.nonsense = {{1, 0}, {1, 1}, {0, 2}, {0xFFFF'FFFF, 0}}});
  worlds.step(boxes);
  constexpr Pair kNone = {0xFFFF'FFFF, 0xFFFF'FFFF};
  EXPECT_EQ(concatenated(worlds.all().overlaps()),
            (Pairs{{2, 0}, {2, 2}, kNone, kNone, {3, 1}, {3, 3}, kNone, kNone}));
}

TEST(PerWorldBroadPhase, AreSharedOutWhereEachWorkerGetsOne) {
  const Ids three = {0, 0, 1, 1, 2, 2};
  const Boxes boxes(three.size(), unitAt(0));
  const auto instance_threads = [&](const Worlds::Options& options) {
    Worlds worlds(worldsOf(three), boxes, options);
    std::vector<int> threads;
    for (std::size_t world = 0; world < worlds.count(); ++world) {
      EXPECT_EQ(worlds.of(world).isa_, Isa::sse2);
      threads.push_back(worlds.of(world).threads_);
    }
    return threads;
  };
  EXPECT_THAT(instance_threads({.threads = 1}), ElementsAre(1, 1, 1));
  EXPECT_THAT(instance_threads({.threads = 2}), ElementsAre(1, 1, 1));
  EXPECT_THAT(instance_threads({.threads = 3}), ElementsAre(1, 1, 1));
  EXPECT_THAT(instance_threads({.threads = 4}), ElementsAre(4, 4, 4));
  EXPECT_THAT(instance_threads({.threads = 2, .concurrent = false}), ElementsAre(2, 2, 2));
}

std::map<std::string, std::uint64_t> countersOf(
    const std::function<void(const CounterVisitor&)>& visit) {
  std::map<std::string, std::uint64_t> counts;
  visit([&](std::string_view name, std::uint64_t count) {
    EXPECT_TRUE(counts.emplace(name, count).second) << name << " comes twice";
  });
  return counts;
}

TEST(PerWorldBroadPhase, TellAndDrawWhatAllInstancesDo) {
  Boxes boxes(7, unitAt(0));
  Worlds worlds(worldsOf({0, 0, 1, 1, 1, 20, 20}), boxes);
  worlds.step(boxes);
  boxes[0] = boxes[2] = boxes[3] = unitAt(1);
  worlds.step(boxes);
  const BroadPhase& all = worlds.all();
  using Counts = std::map<std::string, std::uint64_t>;
  EXPECT_EQ(countersOf([&](const auto& visit) { all.visitCounters(visit); }),
            (Counts{{"worlds with changes", 2}, {"changed", 3}, {"bodies", 5}}));
  EXPECT_EQ(countersOf([&](const auto& visit) { all.visitSetup(visit); }), (Counts{{"starts", 3}}));
  EXPECT_EQ(all.transfers().upload_ns, 2);
  EXPECT_EQ(all.transfers().download_ns, 4);
  RecordedDrawing drawing;
  all.drawStructure(drawing);
  EXPECT_EQ(drawing.boxes().size(), 3U);
  EXPECT_EQ(all.validate(), "");
  worlds.of(2).fault_ = "a leaf is lost";
  EXPECT_EQ(all.validate(), "world 20: a leaf is lost");
}

/// Whether a case with these traits has an instance for each of four worlds of `bodies_each`.
bool isSplit(const AlgorithmTraits& traits, std::uint32_t bodies_each, std::uint32_t worlds = 4) {
  const Pairs no_nonsense;
  Case test_case;
  test_case.algorithm.traits = traits;
  test_case.algorithm.create = [&] { return std::make_unique<Witness>(no_nonsense); };
  Ids body_worlds;
  for (std::uint32_t i = 0; i < 4 * bodies_each; ++i) body_worlds.push_back(i % worlds);
  SceneInfo scene;
  scene.objects = 4 * bodies_each;
  scene.filter = worldsOf(body_worlds);
  const Boxes boxes(scene.objects);
  const Ids none;
  InProcessExecutor host(test_case);
  host.start(scene, {0, boxes, none});
  host.step({1, boxes, none});
  return host.counters().contains("worlds with changes");
}

TEST(PerWorldBroadPhase, AreForThoseWhoWantThemAndForManyBodies) {
  const AlgorithmTraits native = {.changing_worlds = ChangingWorlds::native};
  const AlgorithmTraits native_each = {.changing_worlds = ChangingWorlds::native,
                                       .instance_per_world = true};
  const AlgorithmTraits compacted = {.changing_worlds = ChangingWorlds::compacted};
  const AlgorithmTraits compacted_each = {.changing_worlds = ChangingWorlds::compacted,
                                          .instance_per_world = true};
  const AlgorithmTraits on_device = {.on_device = true,
                                     .changing_worlds = ChangingWorlds::compacted};
  EXPECT_TRUE(isSplit(native_each, 3));
  EXPECT_FALSE(isSplit(native_each, 3, 1));
  EXPECT_FALSE(isSplit(native, 100));
  EXPECT_TRUE(isSplit(compacted_each, 3));
  EXPECT_FALSE(isSplit(compacted, 99));
  EXPECT_TRUE(isSplit(compacted, 100));
  EXPECT_FALSE(isSplit(compacted, 100, 1));
  EXPECT_FALSE(isSplit(on_device, 100));
}

}  // namespace
}  // namespace broadmark::tests
