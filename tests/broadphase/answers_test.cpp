// Answers of the broad-phase library: on all torture inputs, in worlds that change, in any order.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "broadphase/worlds.h"

namespace broadmark::tests {
namespace {

using inputs::Input;
using inputs::Random;

TEST(BroadphaseLibrary, IsRightOnEveryTortureInput) {
  for (const Input& input : allInputs()) {
    for (const std::size_t n : {std::size_t{1}, std::size_t{37}, std::size_t{600}}) {
      std::vector<CheckedBroadPhase> objects;
      std::vector<bp::Options> tested;
      for (bp::Options options : allOptions()) {
        for (const bp::InstructionSet set : instructionSets()) {
          options.instruction_set = set;
          tested.push_back(options);
          objects.emplace_back(options);
        }
      }
      for (std::uint32_t frame = 0; frame < 6; ++frame) {
        const BoxList boxes = input.boxes(n, frame, 1 + n);
        const std::vector<bp::Box> given = publicBoxes(boxes);
        const PairList right = bruteForcePairs(boxes);
        for (std::size_t i = 0; i < objects.size(); ++i) {
          objects[i].object.update(given);
          ASSERT_EQ(objects[i].faultOf(right), "") << input.name << ", " << n << " bodies, frame "
                                                   << frame << ", " << describe(tested[i]);
        }
      }
    }
  }
}

// Enough bodies for several threads.
TEST(BroadphaseLibrary, IsRightOnAnyThreads) {
  constexpr std::size_t kBodies = 20'000;
  for (const Input& input : inputs::kAll) {
    if (input.all_overlap) continue;  // too many pairs
    std::vector<CheckedBroadPhase> objects;
    std::vector<bp::Options> tested;
    for (bp::Options options : allOptions()) {
      for (const int threads : {1, 2, 5}) {
        options.threads = threads;
        options.parallel_for = threads == 5 ? runBackwards : bp::ParallelFor();
        tested.push_back(options);
        objects.emplace_back(options);
      }
    }
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
      const BoxList boxes = input.boxes(kBodies, frame, 1);
      const std::vector<bp::Box> given = publicBoxes(boxes);
      const PairList right = sweptPairs(boxes);
      for (std::size_t i = 0; i < objects.size(); ++i) {
        objects[i].object.update(given);
        ASSERT_EQ(objects[i].faultOf(right), "")
            << input.name << ", frame " << frame << ", " << describe(tested[i]);
      }
    }
  }
}

TEST(BroadphaseLibrary, IsRightWhileBodiesComeAndGoAndPairsAreFiltered) {
  constexpr std::size_t kBodies = 200;
  for (const inputs::NamedFilter& named : inputs::filters(kBodies)) {
    if (!named.filter.worlds().empty()) continue;  // other worlds are other objects
    for (const inputs::NamedPresence& presence : inputs::kPresences) {
      for (bp::Options options : allOptions()) {
        options.collides =
            named.filter.wantsAll() ? LayerMatrix::all().rows() : named.filter.matrix().rows();
        CheckedBroadPhase checked(options);
        for (std::uint32_t body = 0; body < kBodies; ++body) {
          const BodyGroups groups = named.filter.groupsOf(body);
          checked.object.setFilter(body, {groups.layer, groups.tags});
        }
        for (std::uint32_t frame = 0; frame < 8; ++frame) {
          BoxList boxes = inputs::drifting(kBodies, frame, 3);
          for (std::uint32_t body = 0; body < kBodies; ++body) {
            if (!presence.present(body, frame)) boxes[body] = kEmptyBox;
          }
          ASSERT_EQ(checked.update(boxes, named.filter), "")
              << named.name << ", " << presence.name << ", frame " << frame << ", "
              << describe(options);
        }
      }
    }
  }
}

TEST(BroadphaseLibrary, FollowsTheNumberOfBodies) {
  for (const bp::Options& options : allOptions()) {
    CheckedBroadPhase checked(options);
    Random random(5, 0);
    for (std::uint32_t frame = 0; frame < 60; ++frame) {
      const auto n = static_cast<std::size_t>(
          frame % 20 == 0 ? 0 : random.integer(1, 20 * (1 + static_cast<int>(frame) % 20)));
      BoxList boxes = inputs::drifting(n, frame, 3);
      if (frame % 3 == 0 && n > 0) boxes[n / 2] = kEmptyBox;
      ASSERT_EQ(checked.update(boxes), "") << "frame " << frame << ", " << describe(options);
      ASSERT_EQ(checked.object.size(), n);
    }
  }
}

TEST(BroadphaseLibrary, FollowsChangesOfFilters) {
  constexpr std::size_t kBodies = 150;
  for (bp::Options options : allOptions()) {
    LayerMatrix matrix = LayerMatrix().set(0, 1).set(1, 1).set(2, 0);
    options.collides = matrix.rows();
    CheckedBroadPhase checked(options);
    std::vector<BodyGroups> groups(2 * kBodies);
    Random random(7, 0);
    for (std::uint32_t frame = 0; frame < 40; ++frame) {
      for (int change = random.integer(0, 3); change > 0; --change) {
        const auto body = static_cast<std::uint32_t>(random.integer(0, kBodies + 20));
        groups[body].layer = static_cast<std::uint8_t>(random.integer(0, 2));
        groups[body].tags[1] = static_cast<std::uint32_t>(random.integer(0, 9));
        checked.object.setFilter(body, {groups[body].layer, groups[body].tags});
      }
      const std::size_t n = kBodies + (frame > 20 ? frame : 0);
      ASSERT_EQ(checked.update(inputs::clustered(n, frame / 2, 1), {groups, matrix}), "")
          << "frame " << frame << ", " << describe(options);
    }
  }
}

TEST(BroadphaseLibrary, ReadsBoxesWhereverTheyLie) {
  const BoxList boxes = inputs::clustered(100, 0, 1);
  const PairList right = bruteForcePairs(boxes);
  const auto pairsOf = [](const bp::Boxes& view) {
    bp::BroadPhase object;
    object.update(view);
    return listOf(object.pairs());
  };
  EXPECT_EQ(pairsOf({boxes[0].min.data(), boxes[0].max.data(), boxes.size(), sizeof(Aabb)}), right);

  struct Object {
    double mass;
    float max[3];
    float min[3];
  };
  std::vector<Object> objects;
  std::vector<float> mins;
  std::vector<float> maxs;
  for (const Aabb& box : boxes) {
    Object object{};
    std::copy_n(box.max.begin(), 3, object.max);
    std::copy_n(box.min.begin(), 3, object.min);
    objects.push_back(object);
    mins.insert(mins.end(), box.min.begin(), box.min.begin() + 3);
    maxs.insert(maxs.end(), box.max.begin(), box.max.begin() + 3);
  }
  EXPECT_EQ(pairsOf({mins.data(), maxs.data(), boxes.size(), 12}), right);
  EXPECT_EQ(pairsOf({objects[0].min, objects[0].max, boxes.size(), sizeof(Object)}), right);
}

// Two boxes are a pair if their distance is at most twice the margin on each axis.
TEST(BroadphaseLibrary, EnlargesBoxesByTheMarginAndNeverLess) {
  for (const float margin : {0.1F, 1.0F, 1e-7F, 1e30F, std::numeric_limits<float>::max()}) {
    for (const inputs::Generator generator : {inputs::uniform, inputs::farAway, inputs::huge}) {
      bp::Options options;
      options.margin = margin;
      bp::BroadPhase object(options);
      for (std::uint32_t frame = 0; frame < 3; ++frame) {
        const BoxList boxes = generator(200, frame, 1);
        object.update(publicBoxes(boxes));
        const PairList found = listOf(object.pairs());
        BoxList slightly_larger = boxes;
        for (Aabb& box : slightly_larger) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            constexpr float kInfinity = std::numeric_limits<float>::infinity();
            box.min[axis] = std::nextafter(box.min[axis] - margin, -kInfinity);
            box.max[axis] = std::nextafter(box.max[axis] + margin, kInfinity);
          }
        }
        PairList must;
        for (std::uint32_t a = 0; a < boxes.size(); ++a) {
          for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
            bool close = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
              const auto gap = [&](const Aabb& low, const Aabb& high) {
                return static_cast<long double>(high.min[axis]) - low.max[axis];
              };
              close &= std::max(gap(boxes[a], boxes[b]), gap(boxes[b], boxes[a])) <=
                       2 * static_cast<long double>(margin);
            }
            if (close) must.push_back({a, b});
          }
        }
        EXPECT_TRUE(difference(must, found).empty()) << margin;
        EXPECT_TRUE(difference(found, bruteForcePairs(slightly_larger)).empty()) << margin;
      }
    }
  }
}

TEST(BroadphaseLibrary, HasNoAnswerBeforeTheFirstUpdate) {
  bp::BroadPhase object;
  EXPECT_TRUE(object.pairs().empty());
  EXPECT_EQ(object.size(), 0U);
  object.update({});
  EXPECT_TRUE(object.pairs().empty());
  object.update(std::vector<bp::Box>(3, bp::kNoBox));
  EXPECT_TRUE(object.pairs().empty());
}

}  // namespace
}  // namespace broadmark::tests
