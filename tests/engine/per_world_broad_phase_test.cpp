// Several worlds at one place, an instance for each: what each gets to see, and what becomes of
// their answers.

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
  for (const PairRun run : runs) pairs.insert(pairs.end(), run.begin(), run.end());
  return pairs;
}
Pairs sorted(Pairs pairs) {
  std::ranges::sort(pairs);
  return pairs;
}

/// Knows pairs and events by definition, and keeps what it was shown.
class Witness final : public BroadPhase {
 public:
  explicit Witness(const Pairs& nonsense) : nonsense_(nonsense) {}

  [[nodiscard]] float margin() const override { return 0.25F; }
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    scene_ = scene;
    threads_ = execution.threads();
    isa_ = execution.isa();
    look(first);
    began_ = now_ = bruteForcePairs(boxes_, scene.filter);
  }
  void updateObjects(const Frame& frame) override {
    look(frame);
    phases_ = 1;
  }
  void cleanCache() override { phases_ = phases_ * 10 + 2; }
  void updateStructures() override { phases_ = phases_ * 10 + 3; }
  void searchOverlaps() override {
    phases_ = phases_ * 10 + 4;
    const Pairs before = std::exchange(now_, bruteForcePairs(boxes_, scene_.filter));
    began_.clear();
    ended_.clear();
    std::ranges::set_difference(now_, before, std::back_inserter(began_));
    std::ranges::set_difference(before, now_, std::back_inserter(ended_));
    now_.insert(now_.end(), nonsense_.begin(), nonsense_.end());
  }
  [[nodiscard]] PairRuns overlaps() const override {
    const auto half = static_cast<std::ptrdiff_t>(now_.size() / 2);
    runs_ = {PairRun(now_.begin(), now_.begin() + half), PairRun(now_.begin() + half, now_.end())};
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

  // What it was shown.
  SceneInfo scene_;
  int threads_ = 0;
  Isa isa_ = Isa::avx512;
  std::uint32_t index_ = 0;
  Boxes boxes_;
  Ids changed_;
  int frames_ = -1;  ///< after the initial pose
  int phases_ = 0;   ///< of the last frame: 1234
  std::string fault_;

 private:
  void look(const Frame& frame) {
    index_ = frame.index;
    boxes_.assign(frame.boxes.begin(), frame.boxes.end());
    changed_.assign(frame.changed->begin(), frame.changed->end());
    ++frames_;
  }

  const Pairs& nonsense_;
  bool reports_events_ = false;
  Pairs now_;
  Pairs began_;
  Pairs ended_;
  mutable std::vector<PairRun> runs_;
  mutable PairRun began_run_;
  mutable PairRun ended_run_;
};

CollisionFilter worldsOf(const Ids& of_bodies) {
  std::vector<BodyGroups> groups;
  for (const std::uint32_t world : of_bodies) groups.push_back({.world = world});
  return {groups, LayerMatrix().set(0, 0)};
}

Aabb unitAt(float x) { return inputs::boxAt({x, 0, 0}, {1, 1, 1}); }

/// Worlds of witnesses, frame by frame.
class Watched {
 public:
  struct Options {
    int threads = 1;
    bool concurrent = true;
    bool events = false;
    Pairs nonsense = {};
  };

  Watched(const CollisionFilter& filter, const Boxes& first, Options options)
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
  Watched(const CollisionFilter& filter, const Boxes& first) : Watched(filter, first, Options()) {}

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
  /// Its boxes and changes are gone after the call, as those of any frame are.
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
                                    {.world = 4},  // alone: nobody needs to look at it
                                    {.world = 2}};
  const LayerMatrix matrix = LayerMatrix().set(0, 0).set(1, 3);
  Boxes boxes = {unitAt(0), unitAt(1), unitAt(2), unitAt(3), unitAt(4)};
  Watched watched({groups, matrix}, boxes);
  ASSERT_EQ(watched.count(), 2U);
  EXPECT_EQ(watched.all().margin(), 0.25F);
  const Witness& two = watched.of(0);
  const Witness& nine = watched.of(1);
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
  watched.step(boxes);
  EXPECT_EQ(nine.boxes_, (Boxes{boxes[0], boxes[2]}));
  EXPECT_THAT(nine.changed_, ElementsAre(1));
  EXPECT_THAT(two.changed_, IsEmpty());
  EXPECT_EQ(nine.phases_, 1234);
}

TEST(PerWorldBroadPhase, OfOneBodyEachHaveNoInstance) {
  Boxes boxes(3, unitAt(0));
  Watched watched(worldsOf({1, 2, 3}), boxes);
  boxes[1] = unitAt(1);
  watched.step(boxes);
  EXPECT_EQ(watched.count(), 0U);
  EXPECT_THAT(concatenated(watched.all().overlaps()), IsEmpty());
  EXPECT_EQ(watched.all().margin(), 0);
}

TEST(PerWorldBroadPhase, InWhichNothingChangesAreNotTouchedAndKeepTheirAnswers) {
  const CollisionFilter filter = worldsOf({0, 0, 1, 1, 2, 2});
  const Boxes first(6, unitAt(0));
  Boxes boxes = first;
  Watched watched(filter, boxes);
  watched.step(boxes);  // the first frame is for all: before it there are no answers
  for (std::size_t world = 0; world < 3; ++world) EXPECT_EQ(watched.of(world).frames_, 1);
  EXPECT_EQ(concatenated(watched.all().overlaps()), (Pairs{{0, 1}, {2, 3}, {4, 5}}));
  boxes[3] = unitAt(9);
  watched.step(boxes);
  EXPECT_EQ(concatenated(watched.all().overlaps()), (Pairs{{0, 1}, {4, 5}}));
  watched.step(boxes);
  EXPECT_EQ(concatenated(watched.all().overlaps()), (Pairs{{0, 1}, {4, 5}}));
  boxes[0] = unitAt(0.5F);
  boxes[4] = unitAt(9);
  watched.step(boxes);
  EXPECT_EQ(concatenated(watched.all().overlaps()), (Pairs{{0, 1}}));
  EXPECT_EQ(watched.of(0).frames_, 2);
  EXPECT_EQ(watched.of(1).frames_, 2);
  EXPECT_EQ(watched.of(2).frames_, 2);
  // To each its frames are frames that follow each other: what changed is since the one before.
  EXPECT_EQ(watched.of(1).index_, 2U);
}

TEST(PerWorldBroadPhase, InWhichNothingChangesHaveNoEvents) {
  Boxes boxes(4, unitAt(0));
  Watched watched(worldsOf({0, 1, 0, 1}), boxes, {.events = true});
  EXPECT_EQ(concatenated(watched.all().events().began), (Pairs{{0, 2}, {1, 3}}));
  watched.step(boxes);
  EXPECT_EQ(eventCount(watched.all().events()), 0U);
  boxes[3] = unitAt(9);
  watched.step(boxes);
  EXPECT_THAT(concatenated(watched.all().events().began), IsEmpty());
  EXPECT_EQ(concatenated(watched.all().events().ended), (Pairs{{1, 3}}));
  watched.step(boxes);
  EXPECT_EQ(eventCount(watched.all().events()), 0U);
  boxes[0] = unitAt(9);
  boxes[3] = unitAt(0);
  watched.step(boxes);
  EXPECT_EQ(concatenated(watched.all().events().began), (Pairs{{1, 3}}));
  EXPECT_EQ(concatenated(watched.all().events().ended), (Pairs{{0, 2}}));
}

// Some worlds are empty in some frames, or change late; their bodies are mixed.
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
    Watched of_pairs(filter, frames[0], {.threads = threads});
    Watched again(filter, frames[0], {.threads = threads});
    Watched of_events(filter, frames[0], {.threads = threads, .events = true});
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

// Order and repetition are kept; ids that do not exist stay such.
TEST(PerWorldBroadPhase, LetWrongPairsBeWrong) {
  const Boxes boxes = {unitAt(0), unitAt(0), unitAt(5), unitAt(9)};
  Watched watched(worldsOf({0, 1, 0, 1}), boxes,
                  {.nonsense = {{1, 0}, {1, 1}, {0, 2}, {0xFFFF'FFFF, 0}}});
  watched.step(boxes);
  constexpr Pair kNone = {0xFFFF'FFFF, 0xFFFF'FFFF};
  EXPECT_EQ(concatenated(watched.all().overlaps()),
            (Pairs{{2, 0}, {2, 2}, kNone, kNone, {3, 1}, {3, 3}, kNone, kNone}));
}

TEST(PerWorldBroadPhase, AreSharedOutWhereEachWorkerGetsOne) {
  const Ids three = {0, 0, 1, 1, 2, 2};
  const Boxes boxes(three.size(), unitAt(0));
  const auto threads_of_each = [&](const Watched::Options& options) {
    Watched watched(worldsOf(three), boxes, options);
    std::vector<int> threads;
    for (std::size_t world = 0; world < watched.count(); ++world) {
      EXPECT_EQ(watched.of(world).isa_, Isa::sse2);
      threads.push_back(watched.of(world).threads_);
    }
    return threads;
  };
  EXPECT_THAT(threads_of_each({.threads = 1}), ElementsAre(1, 1, 1));
  EXPECT_THAT(threads_of_each({.threads = 2}), ElementsAre(1, 1, 1));
  EXPECT_THAT(threads_of_each({.threads = 3}), ElementsAre(1, 1, 1));
  EXPECT_THAT(threads_of_each({.threads = 4}), ElementsAre(4, 4, 4));
  EXPECT_THAT(threads_of_each({.threads = 2, .concurrent = false}), ElementsAre(2, 2, 2));
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
  Watched watched(worldsOf({0, 0, 1, 1, 1, 20, 20}), boxes);
  watched.step(boxes);
  boxes[0] = boxes[2] = boxes[3] = unitAt(1);
  watched.step(boxes);
  const BroadPhase& all = watched.all();
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
  watched.of(2).fault_ = "a leaf is lost";
  EXPECT_EQ(all.validate(), "world 20: a leaf is lost");
}

/// Whether a case with these traits has an instance for each of four worlds of so many bodies.
bool isApart(const AlgorithmTraits& traits, std::uint32_t bodies_each, std::uint32_t worlds = 4) {
  const Pairs no_nonsense;
  Case run;
  run.algorithm.traits = traits;
  run.algorithm.create = [&] { return std::make_unique<Witness>(no_nonsense); };
  Ids of_bodies;
  for (std::uint32_t i = 0; i < 4 * bodies_each; ++i) of_bodies.push_back(i % worlds);
  SceneInfo scene;
  scene.objects = 4 * bodies_each;
  scene.filter = worldsOf(of_bodies);
  const Boxes boxes(scene.objects);
  const Ids none;
  InProcessExecutor host(run);
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
  EXPECT_TRUE(isApart(native_each, 3));
  EXPECT_FALSE(isApart(native_each, 3, 1));
  EXPECT_FALSE(isApart(native, 100));
  EXPECT_TRUE(isApart(compacted_each, 3));
  EXPECT_FALSE(isApart(compacted, 99));
  EXPECT_TRUE(isApart(compacted, 100));
  EXPECT_FALSE(isApart(compacted, 100, 1));
  EXPECT_FALSE(isApart(on_device, 100));
}

}  // namespace
}  // namespace broadmark::tests
