// Saved and restored states of the broad-phase library.

#include <gtest/gtest.h>

#include <stdexcept>

#include "broadphase/worlds.h"

namespace broadmark::tests {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::uint32_t kFrames = 12;

/// A world with everything that a state consists of.
BoxList boxesAt(std::uint32_t frame) {
  BoxList boxes = inputs::drifting(150 + 10 * frame, frame, 3);
  for (std::uint32_t body = 0; body < boxes.size(); ++body) {
    if (inputs::presences::random(body, frame / 4)) continue;
    boxes[body] = kEmptyBox;
  }
  return boxes;
}

void step(bp::BroadPhase& object, std::uint32_t frame) {
  object.setFilter(3 * frame, {frame % 3, {frame / 2, bp::Filter::kNoTag, 7}});
  object.update(publicBoxes(boxesAt(frame)));
}

struct Moment {
  Bytes state;
  PairList pairs;
  PairList began;
  PairList ended;

  friend bool operator==(const Moment&, const Moment&) = default;
};

Moment momentOf(const bp::BroadPhase& object, bp::Answer answer) {
  Moment moment;
  object.save(moment.state);
  if (answer == bp::Answer::pairs) {
    moment.pairs = listOf(object.pairs());
  } else {
    moment.began = listOf(object.began());
    moment.ended = listOf(object.ended());
  }
  return moment;
}

/// With sorted answers.
std::vector<bp::Options> sortedOptions() {
  std::vector<bp::Options> all = allOptions();
  std::erase_if(all, [](const bp::Options& o) { return o.order != bp::Order::sorted; });
  for (bp::Options& options : all) {
    options.margin = 0.01F;
    options.setCollides(1, 2, false);
  }
  return all;
}

TEST(BroadphaseState, GivesTheSameAnswersAndBytesOnceRestored) {
  for (const bp::Options& options : sortedOptions()) {
    bp::BroadPhase object(options);
    std::vector<Moment> moments;
    for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
      step(object, frame);
      moments.push_back(momentOf(object, options.answer));
    }
    for (const std::uint32_t from : {0U, 3U, 4U, kFrames - 1, 7U}) {
      object.restore(moments[from].state);  // whatever it did before
      EXPECT_EQ(momentOf(object, options.answer), moments[from]) << describe(options);
      for (std::uint32_t frame = from + 1; frame < kFrames; ++frame) {
        step(object, frame);
        ASSERT_EQ(momentOf(object, options.answer), moments[frame])
            << "frame " << frame << " from " << from << ", " << describe(options);
      }
    }
  }
}

// Peers of a networked game have other processors.
TEST(BroadphaseState, DoesNotDependOnMethodThreadsOrInstructionSet) {
  for (const bp::Answer answer : {bp::Answer::pairs, bp::Answer::events}) {
    std::vector<Moment> moments;
    bp::Options first = sortedOptions()[0];
    first.answer = answer;
    bp::BroadPhase object(first);
    for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
      step(object, frame);
      moments.push_back(momentOf(object, answer));
    }
    for (bp::Options other : sortedOptions()) {
      if (other.answer != answer) continue;
      for (const bp::InstructionSet set : instructionSets()) {
        other.instruction_set = set;
        bp::BroadPhase peer(other);
        peer.restore(moments[4].state);
        for (std::uint32_t frame = 5; frame < kFrames; ++frame) {
          step(peer, frame);
          ASSERT_EQ(momentOf(peer, answer), moments[frame]) << describe(other);
        }
      }
    }
  }
}

TEST(BroadphaseState, OfNoUpdateYetIsAStateToo) {
  for (const bp::Options& options : sortedOptions()) {
    bp::BroadPhase object(options);
    const Moment empty = momentOf(object, options.answer);
    step(object, 0);
    const Moment first = momentOf(object, options.answer);
    object.restore(empty.state);
    EXPECT_EQ(object.size(), 0U);
    EXPECT_EQ(momentOf(object, options.answer), empty);
    step(object, 0);
    EXPECT_EQ(momentOf(object, options.answer), first);
  }
}

TEST(BroadphaseState, RefusesAnythingElseAndStaysAsItWas) {
  for (const bp::Options& options : sortedOptions()) {
    bp::BroadPhase object(options);
    for (std::uint32_t frame = 0; frame < 3; ++frame) step(object, frame);
    const Moment moment = momentOf(object, options.answer);
    step(object, 3);
    const Moment later = momentOf(object, options.answer);
    for (std::size_t size = 0; size < moment.state.size(); size += 1 + size / 50) {
      EXPECT_THROW(object.restore(std::span(moment.state).first(size)), std::invalid_argument);
    }
    Bytes longer = moment.state;
    longer.push_back(std::byte{0});
    EXPECT_THROW(object.restore(longer), std::invalid_argument);
    EXPECT_EQ(momentOf(object, options.answer), later);

    // A bad byte is refused, or means another world.
    for (std::size_t i = 0; i < moment.state.size(); i += 1 + i / 100) {
      Bytes bad = moment.state;
      bad[i] ^= std::byte{0xFF};
      try {
        object.restore(bad);
        EXPECT_EQ(momentOf(object, options.answer).state, bad) << "byte " << i;
      } catch (const std::invalid_argument&) {
      }
    }
    object.restore(moment.state);
    EXPECT_EQ(momentOf(object, options.answer), moment);

    for (auto change : {+[](bp::Options& o) { o.margin = 1; },
                        +[](bp::Options& o) { o.collides[0] = 0xFFFF'FFFE; },
                        +[](bp::Options& o) {
                          o.answer = o.answer == bp::Answer::pairs ? bp::Answer::events
                                                                   : bp::Answer::pairs;
                        }}) {
      bp::Options other = options;
      change(other);
      EXPECT_THROW(bp::BroadPhase(other).restore(moment.state), std::invalid_argument);
    }
  }
}

TEST(BroadphaseState, IsNotSavedWithFiltersThatAreNotInUse) {
  bp::BroadPhase object;
  step(object, 0);
  object.setFilter(1, {.layer = 1});
  Bytes state;
  EXPECT_THROW(object.save(state), std::logic_error);
}

}  // namespace
}  // namespace broadmark::tests
