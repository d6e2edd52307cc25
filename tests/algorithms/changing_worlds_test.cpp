// Every listed algorithm must find the right pairs in every frame, in every configuration, in
// worlds with bodies that appear and vanish, with collision filters, which may change, and across
// the boundaries of periodic worlds.

#include <gtest/gtest.h>

#include <filesystem>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "algorithms/runs.h"
#include "broadmark/recordings/recording.h"
#include "support/changing_worlds.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

class EveryAlgorithmInChangingWorlds : public testing::TestWithParam<Algorithm> {
 protected:
  void SetUp() override {
    for (const Configuration& config : allConfigurations(GetParam())) {
      test_runs_.emplace_back(describe(GetParam(), config), TestRun(GetParam(), config));
    }
  }

  /// Runs all configurations over the frames and checks every answer.
  void check(const ChangingWorld& world) {
    SceneInfo scene = sceneOf(world.frames);
    if (world.bounds) scene.world = *world.bounds;
    scene.all_present = false;
    scene.filter = world.filterOf(0);
    scene.filter_changes = !world.filters.empty();
    scene.periodic = world.periodic;
    std::vector<std::vector<Pair>> right;
    for (const auto& boxes : world.frames) {
      right.push_back(bruteForcePairs(boxes, world.filterOf(right.size()), world.periodic));
    }
    for (auto& [name, test_run] : test_runs_) {
      SCOPED_TRACE(name + " on " + world.name + ", n = " + std::to_string(scene.objects));
      try {
        test_run.start(scene, world.frames[0]);
        for (std::uint32_t i = 1; i < world.frames.size(); ++i) {
          const CollisionFilter& filter = world.filterOf(i);
          const PairRuns answer =
              test_run.step(world.frames[i], scene.filter_changes ? &filter : nullptr);
          ASSERT_TRUE(isRight(answer, right[i], {i, world.frames[i]}, test_run.margin(), filter,
                              world.periodic))
              << "in frame " << i;
          ASSERT_EQ(test_run.broadPhase().validate(), "") << "in frame " << i;
        }
      } catch (const UnsupportedError& error) {
        GTEST_SKIP() << error.what();
      } catch (const std::exception& error) {
        FAIL() << error.what();
      }
    }
  }

 private:
  std::list<std::pair<std::string, TestRun>> test_runs_;  ///< by name of the configuration
};

TEST_P(EveryAlgorithmInChangingWorlds, FindsExactlyTheRightPairs) {
  constexpr std::uint32_t kFrames = 8;
  constexpr inputs::Input kInputs[] = {
      {"drifting", inputs::drifting}, {"clustered", inputs::clustered}, {"still", inputs::still}};
  constexpr std::size_t kCounts[] = {150, 0, 33, 1, 100, 2, 17};
  const std::size_t kinds = filters(1).size();
  std::size_t turn = 0;
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    for (const auto& [presence_name, present] : inputs::kPresences) {
      // Seven counts, seven presences: shifted, or each count would always have the same presence.
      const std::size_t n = kCounts[(turn + kind) % std::size(kCounts)];
      const inputs::Input& input = kInputs[turn++ % std::size(kInputs)];
      const NamedFilter filter = filters(n)[kind];
      check({std::string(input.name) + ", " + filter.name + ", " + std::string(presence_name),
             filter.filter, framesWith(input, n, kFrames, present)});
      if (HasFatalFailure() || IsSkipped()) return;
    }
  }
}

// Every filter, with bodies that change layers and tags, in all, some, or few frames.
TEST_P(EveryAlgorithmInChangingWorlds, FollowsFiltersThatChange) {
  constexpr std::uint32_t kFrames = 9;
  constexpr inputs::Input kInputs[] = {
      {"still", inputs::still}, {"drifting", inputs::drifting}, {"clustered", inputs::clustered}};
  constexpr std::size_t kCounts[] = {120, 33, 2, 60, 17};
  std::size_t turn = 0;
  for (std::size_t kind = 0; kind < filters(1).size(); ++kind) {
    for (const auto& [change_name, changes] : inputs::kFilterChanges) {
      const std::size_t n = kCounts[turn % std::size(kCounts)];
      const inputs::Input& input = kInputs[turn / 2 % std::size(kInputs)];
      const auto& [presence_name, present] = inputs::kPresences[turn++ % inputs::kPresences.size()];
      const NamedFilter filter = filters(n)[kind];
      check({.name = fmt::format("{}, {}, {}, filters: {}", input.name, filter.name, presence_name,
                                 change_name),
             .filter = {},
             .frames = framesWith(input, n, kFrames, present),
             .filters = inputs::changingFilters(filter.filter, n, kFrames - 1, changes, turn)});
      if (HasFatalFailure() || IsSkipped()) return;
    }
  }
}

/// The middle of the boxes' bounds, along these axes: bodies lie several periods away.
PeriodicBox middleOf(const std::vector<Aabb>& boxes, unsigned axes) {
  Aabb bounds = kEmptyBox;
  for (const Aabb& box : boxes) bounds = merged(bounds, box);
  PeriodicBox periodic;
  for (int axis = 0; axis < 3; ++axis) {
    if ((axes >> axis & 1) == 0 || isEmpty(bounds)) continue;
    const double extent = std::max(1e-3, double{bounds.max[axis]} - bounds.min[axis]);
    periodic.min[axis] = bounds.min[axis] + 0.4 * extent;
    periodic.max[axis] = periodic.min[axis] + 0.3 * extent;
  }
  return periodic;
}

TEST_P(EveryAlgorithmInChangingWorlds, FindsPairsAcrossPeriodicBoundaries) {
  constexpr std::uint32_t kFrames = 6;
  constexpr inputs::Input kInputs[] = {
      {"drifting", inputs::drifting}, {"clustered", inputs::clustered}, {"still", inputs::still}};
  constexpr std::size_t kCounts[] = {120, 33, 2, 60, 17, 1};
  std::size_t turn = 0;
  for (unsigned axes = 1; axes < 8; ++axes) {
    for (const auto& [presence_name, present] : inputs::kPresences) {
      const std::size_t n = kCounts[turn % std::size(kCounts)];
      const inputs::Input& input = kInputs[turn / 2 % std::size(kInputs)];
      const NamedFilter filter = filters(n)[turn++ % filters(1).size()];
      ChangingWorld world{
          .name = fmt::format("{}, {}, {}, axes {}", input.name, filter.name, presence_name, axes),
          .filter = filter.filter,
          .frames = framesWith(input, n, kFrames, present)};
      world.periodic = middleOf(input.boxes(n, 0, 1 + n), axes);
      for (auto& boxes : world.frames) {
        for (Aabb& box : boxes) box = wrapped(box, world.periodic);
      }
      check(world);
      if (HasFatalFailure() || IsSkipped()) return;
    }
  }
}

// Few images at first, then seven of every body: more than the adapter has slots for.
TEST_P(EveryAlgorithmInChangingWorlds, FindsPairsOfManyImagesThatAppearAtOnce) {
  ChangingWorld world{.name = "into a corner", .filter = {}, .frames = {}};
  world.periodic = {{0, 0, 0}, {10, 10, 10}};
  for (const float corner : {4.0F, 9.5F, 4.0F, 9.5F, 0.0F}) {
    std::vector<Aabb>& boxes = world.frames.emplace_back();
    inputs::Random random(7, 0);
    for (int body = 0; body < 60; ++body) {
      const inputs::Vec3 at = {corner + random.uniform(0, 0.4F), corner + random.uniform(0, 0.4F),
                               corner + random.uniform(0, 0.4F)};
      boxes.push_back(inputs::boxAt(at, {1, 1, body % 7 == 0 ? 30.0F : 1.0F}));
    }
  }
  check(world);
}

TEST_P(EveryAlgorithmInChangingWorlds, FollowsFiltersThatChangeAmongManyBodies) {
  constexpr std::size_t kMany = 1200;
  std::size_t turn = 0;
  for (const auto& [filter_name, filter] : filters(kMany)) {
    const auto& [presence_name, present] = inputs::kPresences[turn % inputs::kPresences.size()];
    const auto& [change_name, changes] = inputs::kFilterChanges[turn++ % 2];
    check({.name = fmt::format("{}, {}, filters: {}", filter_name, presence_name, change_name),
           .filter = {},
           .frames = framesWith({"drifting", inputs::drifting}, kMany, 5, present),
           .filters = inputs::changingFilters(filter, kMany, 4, changes, turn)});
    if (HasFatalFailure() || IsSkipped()) return;
  }
}

// Enough bodies for all structures to be divided.
TEST_P(EveryAlgorithmInChangingWorlds, FindsThemAmongManyBodies) {
  constexpr std::size_t kMany = 1500;
  std::size_t turn = 0;
  for (const auto& [filter_name, filter] : filters(kMany)) {
    const auto& [presence_name, present] = inputs::kPresences[turn++ % inputs::kPresences.size()];
    check({filter_name + ", " + std::string(presence_name), filter,
           framesWith({"drifting", inputs::drifting}, kMany, 5, present)});
    if (HasFatalFailure() || IsSkipped()) return;
  }
}

TEST_P(EveryAlgorithmInChangingWorlds, FindsThemOnEveryInput) {
  constexpr std::size_t kSome = 120;
  const std::vector<NamedFilter> all = filters(kSome);
  for (const inputs::Input& input : inputs::kAll) {
    check({std::string(input.name), all.back().filter,
           framesWith(input, kSome, 6, presences::random)});
    if (HasFatalFailure() || IsSkipped()) return;
  }
}

/// Frames in which only bodies with changes(body, frame) take their boxes of the source's frame.
std::vector<std::vector<Aabb>> framesInWhich(
    const std::vector<std::vector<Aabb>>& source,
    const std::function<bool(std::uint32_t body, std::uint32_t frame)>& changes) {
  std::vector<std::vector<Aabb>> frames = {source[0]};
  for (std::uint32_t frame = 1; frame < source.size(); ++frame) {
    frames.push_back(frames.back());
    for (std::uint32_t body = 0; body < source[0].size(); ++body) {
      if (changes(body, frame)) frames.back()[body] = source[frame][body];
    }
  }
  return frames;
}

// A static level without pairs of its own; one in twenty bodies moves in it. One body of the level
// moves once, one vanishes and reappears, and one appears late.
TEST_P(EveryAlgorithmInChangingWorlds, FindsThemInALevel) {
  constexpr std::size_t kMany = 1000;
  constexpr std::uint32_t kElevator = 1;
  constexpr std::uint32_t kDoor = 2;
  constexpr std::uint32_t kLate = 3;
  const auto moves = [](std::uint32_t body) { return body % 20 == 0; };
  const CollisionFilter filter =
      filterOf(kMany, LayerMatrix().set(0, 1).set(1, 1), [&](inputs::Random&, std::uint32_t body) {
        return BodyGroups{.layer = std::uint8_t{moves(body)}};
      });
  for (const inputs::Generator input : {inputs::teleporting, inputs::drifting}) {
    const auto source = framesOf({"level", input}, kMany, 12);
    auto frames = framesInWhich(source, [&](std::uint32_t body, std::uint32_t frame) {
      return moves(body) || (body == kElevator && frame == 4);
    });
    for (std::uint32_t frame = 0; frame < frames.size(); ++frame) {
      if (frame >= 3 && frame < 6) frames[frame][kDoor] = kEmptyBox;
      if (frame < 5) frames[frame][kLate] = kEmptyBox;
      // All moving bodies vanish, and reappear in the unchanged level.
      for (std::uint32_t body = 0; frame == 2 && body < kMany; ++body) {
        if (moves(body)) frames[frame][body] = kEmptyBox;
      }
      if (frame == 7) frames[frame] = frames[frame - 1];  // nothing changes
    }
    // All bodies move to the first body; then all but the level vanish.
    for (std::uint32_t body = 0; body < kMany; ++body) {
      frames[9][body] = frames[9][0];
      if (moves(body)) frames[10][body] = kEmptyBox;
    }
    check({"level", filter, frames});
    if (HasFatalFailure() || IsSkipped()) return;
    // Some boxes of the level join the moving bodies, and later all bodies join the level.
    std::vector filters = {filter};
    for (std::uint32_t frame = 1; frame < frames.size(); ++frame) {
      std::vector<std::uint32_t> changed;
      for (std::uint32_t body = frame; frame != 7 && body < kMany; body += 97) {
        changed.push_back(body);
      }
      const BodyGroups groups{.layer = std::uint8_t{frame < 5}};
      filters.push_back(filters.back().with(changed, std::vector(changed.size(), groups), kMany));
    }
    check(
        {.name = "level with changing layers", .filter = {}, .frames = frames, .filters = filters});
    if (HasFatalFailure() || IsSkipped()) return;
  }
}

TEST_P(EveryAlgorithmInChangingWorlds, FindsThemWhereOneBodyChangesOrNone) {
  constexpr std::size_t kMany = 600;
  const auto source = framesOf({"teleporting", inputs::teleporting}, kMany, 10);
  const auto frames = framesInWhich(source, [](std::uint32_t body, std::uint32_t frame) {
    return frame % 3 != 0 && body == frame * 7;
  });
  for (const NamedFilter& filter : {filters(kMany)[0], filters(kMany)[2]}) {
    check({"one body, " + filter.name, filter.filter, frames});
    if (HasFatalFailure() || IsSkipped()) return;
  }
}

// Worlds at the same position, with a few bodies each; some extend beyond the bounds by more than
// their size. A third of the worlds is static; others appear late, with all bodies, vanish for a
// frame, or are never present.
TEST_P(EveryAlgorithmInChangingWorlds, FindsThemInAThousandWorlds) {
  constexpr std::uint32_t kWorlds = 1000;
  constexpr std::uint32_t kAll = 2500;
  const CollisionFilter filter = filterOf(
      kAll, LayerMatrix().set(0, 0).set(1, 1), [](inputs::Random& random, std::uint32_t body) {
        return BodyGroups{.layer = std::uint8_t{body % 11 == 0},
                          .world = static_cast<std::uint32_t>(7 * random.integer(1, kWorlds))};
      });
  std::vector<std::vector<Aabb>> frames;
  for (std::uint32_t frame = 0; frame < 5; ++frame) {
    std::vector<Aabb>& boxes = frames.emplace_back(kAll, kEmptyBox);
    for (std::uint32_t body = 0; body < kAll; ++body) {
      const std::uint32_t world = filter.worlds()[body] / 7;
      if (world % 6 > frame || world % 10 == frame) continue;
      inputs::Random random(body, world % 3 == 0 ? 0 : frame);
      const float side = body % 50 == 49 ? 100.0F : 4.0F;
      boxes[body] = inputs::boxAt(random.inCube(side), {1, 1, 1});
    }
  }
  check({"a thousand worlds", filter, frames, Aabb{{0, 0, 0, 0}, {5, 5, 5, 0}}});
}

// Regressions of faults that a torture found: each recording in tests/found is checked.
TEST_P(EveryAlgorithmInChangingWorlds, IsRightOnWhatATortureFound) {
  for (const auto& entry : std::filesystem::directory_iterator(places::source("tests/found"))) {
    const std::unique_ptr<Recording> recording = openRecordingFile(entry.path());
    ChangingWorld world{
        entry.path().stem(), recording->scene().filter, {}, recording->scene().world};
    for (auto frame = std::optional(recording->rewind()); frame; frame = recording->next()) {
      world.frames.emplace_back(frame->boxes.begin(), frame->boxes.end());
      if (frame->filter != nullptr) world.filters.push_back(*frame->filter);
    }
    check(world);
    if (HasFatalFailure() || IsSkipped()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Algorithms, EveryAlgorithmInChangingWorlds,
                         testing::ValuesIn(pairFinders()),
                         [](const auto& tested) { return testName(tested.param); });

}  // namespace
}  // namespace broadmark::tests
