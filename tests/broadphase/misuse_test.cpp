// Misuse of the broad-phase library: an exception, and a state as before.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>

#include "broadphase/worlds.h"

namespace broadmark::tests {
namespace {

using testing::HasSubstr;

class BroadphaseMisuse : public testing::Test {
 protected:
  BroadphaseMisuse() { object_.update(boxes_); }

  /// Nothing has happened.
  void expectUnchanged() {
    EXPECT_EQ(object_.size(), kBodies);
    EXPECT_EQ(listOf(object_.pairs()), oracle(inputs::clustered(kBodies, 0, 1)));
    object_.update(boxes_);
    EXPECT_EQ(listOf(object_.pairs()), oracle(inputs::clustered(kBodies, 0, 1)));
  }

  static constexpr std::size_t kBodies = 100;
  std::vector<bp::Box> boxes_ = publicBoxes(inputs::clustered(kBodies, 0, 1));
  bp::BroadPhase object_;
};

TEST_F(BroadphaseMisuse, OfBoxesThrows) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto with = [&](float min, float max) {
    std::vector<bp::Box> boxes = boxes_;
    boxes[3] = {{5, 5, 5}, {6, 6, 6}};
    boxes[17].min[1] = min;
    boxes[17].max[1] = max;
    return invalidArgument([&] { object_.update(boxes); });
  };
  EXPECT_EQ(with(NAN, 1), "body 17: y is NaN");
  EXPECT_EQ(with(1, NAN), "body 17: y is NaN");
  EXPECT_EQ(with(2, 1), "body 17: min > max; absent bodies have kNoBox");
  EXPECT_THAT(with(-kInfinity, 1), HasSubstr("body 17: y is infinite"));
  EXPECT_THAT(with(1, kInfinity), HasSubstr("body 17: y is infinite"));
  EXPECT_THAT(with(kInfinity, -kInfinity), HasSubstr("body 17: min > max"));
  expectUnchanged();
}

TEST_F(BroadphaseMisuse, OfArraysThrows) {
  const float* const first = boxes_[0].min;
  EXPECT_THAT(invalidArgument([&] { object_.update({nullptr, first, 1, 24}); }), HasSubstr("null"));
  EXPECT_THAT(invalidArgument([&] { object_.update({first, nullptr, 1, 24}); }), HasSubstr("null"));
  EXPECT_THAT(invalidArgument([&] { object_.update({first, first, 2, 8}); }), HasSubstr("stride"));
  EXPECT_EQ(
      invalidArgument([&] { object_.update({first, first, bp::BroadPhase::kMaxBodies + 1, 24}); }),
      "536870912 bodies: at most 536870911 are supported");
  EXPECT_THAT(invalidArgument([&] { object_.setFilter(0, {.layer = 32}); }),
              HasSubstr("layers 0 to 31"));
  EXPECT_THAT(invalidArgument([&] { object_.setFilter(0xFFFF'FFFF, {}); }), HasSubstr("536870910"));
  expectUnchanged();
}

TEST_F(BroadphaseMisuse, OfOptionsThrows) {
  const auto with = [](auto change) {
    bp::Options options;
    change(options);
    return invalidArgument([&] { const bp::BroadPhase object(options); });
  };
  EXPECT_THAT(with([](auto& o) { o.threads = 0; }), HasSubstr("threads"));
  EXPECT_THAT(with([](auto& o) { o.threads = 100'000; }), HasSubstr("threads"));
  EXPECT_THAT(with([](auto& o) { o.margin = -1; }), HasSubstr("margin"));
  EXPECT_THAT(with([](auto& o) { o.margin = NAN; }), HasSubstr("margin"));
  EXPECT_THAT(with([](auto& o) { o.collides[3] = 0; }), HasSubstr("layers 0 and 3"));
  EXPECT_EQ(with([](auto& o) { o.setCollides(3, 0, false); }), "no exception");
  EXPECT_THROW(with([](auto& o) { o.setCollides(3, 32); }), std::out_of_range);
  EXPECT_EQ(with([](auto& o) { o.method = static_cast<bp::Method>(2); }),
            "method: invalid value 2");
  EXPECT_EQ(with([](auto& o) { o.order = static_cast<bp::Order>(-1); }), "order: invalid value -1");
  const bp::InstructionSet foreign =
      isaSupported(Isa::sse2) ? bp::InstructionSet::neon : bp::InstructionSet::sse2;
  EXPECT_THAT(with([&](auto& o) { o.instruction_set = foreign; }), HasSubstr("not supported"));
  EXPECT_THAT(with([](auto& o) { o.instruction_set = bp::InstructionSet::simd128; }),
              HasSubstr("not supported"));
}

TEST_F(BroadphaseMisuse, OfAnswersThrows) {
  EXPECT_EQ(messageOf<std::logic_error>([&] { (void)object_.began(); }),
            "the answer is pairs: use pairs()");
  bp::Options options;
  options.answer = bp::Answer::events;
  const bp::BroadPhase events(options);
  EXPECT_THAT(messageOf<std::logic_error>([&] { (void)events.pairs(); }), HasSubstr("events"));
  const bp::BroadPhase other = std::move(object_);
  EXPECT_EQ(other.size(), kBodies);
  EXPECT_THAT(messageOf<std::logic_error>([&] { object_.update({}); }), HasSubstr("moved"));
}

TEST_F(BroadphaseMisuse, OfIdsThrows) {
  const bp::Box moved = {{5, 5, 5}, {6, 6, 6}};
  std::vector<bp::Box> boxes = boxes_;
  boxes[20] = boxes[50] = moved;
  const auto update = [&](std::vector<std::uint32_t> changed) {
    return invalidArgument([&] { object_.update(boxes, changed); });
  };
  EXPECT_EQ(update({1, 20}), "changed: body 50 is not listed, but its box has changed");
  EXPECT_EQ(update({50, 1}), "changed: body 20 is not listed, but its box has changed");
  EXPECT_EQ(update({}), "changed: body 20 is not listed, but its box has changed");
  EXPECT_EQ(update({100}), "changed: no body 100: there are 100");
  expectUnchanged();
  EXPECT_EQ(update({50, 99, 20, 50, 3}), "no exception");  // more than needed
  PairList right;
  boxes_.swap(boxes);
  BoxList list;
  for (const bp::Box& box : boxes_) {
    list.push_back(
        {{box.min[0], box.min[1], box.min[2], 0}, {box.max[0], box.max[1], box.max[2], 0}});
  }
  EXPECT_EQ(listOf(object_.pairs()), oracle(list));
}

// Bodies that are not listed stay as they were.
TEST(BroadphaseChanges, AreTrustedOnRequest) {
  constexpr std::uint32_t kBodies = 200;
  for (bp::Options options : allOptions()) {
    options.changes = bp::Changes::trusted;
    CheckedBroadPhase checked(options);
    BoxList known = inputs::clustered(kBodies, 0, 1);
    ASSERT_EQ(checked.update(known), "");
    for (std::uint32_t frame = 1; frame < 20; ++frame) {
      BoxList boxes = inputs::clustered(kBodies + frame / 5 * 40, frame, 1);
      if (frame % 7 == 0) boxes.resize(kBodies / 2);
      std::vector<std::uint32_t> changed;
      for (std::uint32_t i = 0; i < 20; ++i) changed.push_back((17 * i + frame) % 90);
      if (frame % 3 == 0) boxes[changed[2]] = kEmptyBox;
      const std::size_t before = known.size();
      known.resize(boxes.size());
      for (const std::uint32_t body : changed) known[body] = boxes[body];
      for (std::size_t body = before; body < boxes.size(); ++body) known[body] = boxes[body];
      checked.object.update(publicBoxes(boxes), changed);
      ASSERT_EQ(checked.faultOf(oracle(known)), "") << "frame " << frame << describe(options);
    }
    const std::vector<std::uint32_t> beyond = {12, 100'000};
    EXPECT_THROW(checked.object.update(publicBoxes(known), beyond), std::invalid_argument);
  }
}

/// An object that uses a job system.
class BroadphaseJobs : public testing::Test {
 protected:
  BroadphaseJobs() {
    options_.threads = 3;
    options_.parallel_for = [this](int jobs, const std::function<void(int)>& job) {
      run_(jobs, job);
    };
  }

  /// An update whose jobs are run so must throw this; it must be followed by restore().
  template <class Error>
  void expectFailure(const bp::ParallelFor& run, const std::string& message) {
    bp::BroadPhase object(options_);
    run_ = runBackwards;
    object.update(boxes_);
    const PairList right = listOf(object.pairs());
    std::vector<std::byte> state;
    object.save(state);
    run_ = run;
    const std::vector<bp::Box> moved = publicBoxes(inputs::uniform(kBodies, 1, 1));
    EXPECT_THAT(messageOf<Error>([&] { object.update(moved); }), HasSubstr(message));
    run_ = runBackwards;
    EXPECT_THAT(messageOf<std::logic_error>([&] { object.update(boxes_); }),
                HasSubstr("only restore()"));
    EXPECT_THROW(object.save(state), std::logic_error);
    EXPECT_THROW((void)object.pairs(), std::logic_error);
    EXPECT_THROW(object.setFilter(0, {}), std::logic_error);
    object.restore(state);
    EXPECT_EQ(listOf(object.pairs()), right);
    object.update(moved);
    EXPECT_EQ(listOf(object.pairs()), oracle(inputs::uniform(kBodies, 1, 1)));
  }

  static constexpr std::size_t kBodies = 20'000;  // enough for several threads
  bp::Options options_;
  bp::ParallelFor run_ = runBackwards;
  std::vector<bp::Box> boxes_ = publicBoxes(inputs::uniform(kBodies, 0, 1));
};

TEST_F(BroadphaseJobs, AreEachRunOnce) {
  const std::string message = "exactly once";
  expectFailure<std::logic_error>([](int, const std::function<void(int)>&) {}, message);
  expectFailure<std::logic_error>([](int jobs, const auto& job) { runBackwards(jobs - 1, job); },
                                  message);
  expectFailure<std::logic_error>([](int jobs, const auto& job) { runBackwards(jobs + 1, job); },
                                  message);
  expectFailure<std::logic_error>(
      [](int jobs, const auto& job) {
        runBackwards(jobs, job);
        job(0);
      },
      message);
}

TEST_F(BroadphaseJobs, MayThrow) {
  expectFailure<std::runtime_error>(
      [](int, const auto&) { throw std::runtime_error("no more jobs"); }, "no more jobs");
}

TEST_F(BroadphaseJobs, MayThrowAfterAJobHas) {
  bool fails = true;
  ThreadTeam team(2, [&](int jobs, const std::function<void(int)>& job) {
    runBackwards(jobs, job);
    if (fails) throw std::runtime_error("no more jobs");
  });
  EXPECT_THROW(team.run([](int) { throw std::bad_alloc(); }), std::runtime_error);
  fails = false;
  EXPECT_NO_THROW(team.run([](int) {}));
}

TEST_F(BroadphaseJobs, MustNotUseTheObject) {
  bp::BroadPhase object(options_);
  object.update(boxes_);
  const PairList right = listOf(object.pairs());
  std::atomic<int> refused{0};
  run_ = [&](int jobs, const std::function<void(int)>& job) {
    runBackwards(jobs, job);
    std::thread other([&] {
      const auto refuses = [&](auto call) {
        if (messageOf<std::logic_error>(call).find("another") != std::string::npos) ++refused;
      };
      std::vector<std::byte> state;
      refuses([&] { object.update(boxes_); });
      refuses([&] { (void)object.pairs(); });
      refuses([&] { object.setFilter(0, {}); });
      bp::QueryResults<std::uint32_t> bodies;
      refuses([&] { object.overlapping({}, bodies); });
      refuses([&] { object.save(state); });
      refuses([&] { object.restore(state); });
    });
    other.join();
  };
  std::vector<bp::Box> moved = publicBoxes(inputs::uniform(kBodies, 1, 1));
  object.update(moved);
  EXPECT_GT(refused, 0);
  EXPECT_EQ(refused % 6, 0);
  run_ = runBackwards;
  object.update(boxes_);
  EXPECT_EQ(listOf(object.pairs()), right);
}

}  // namespace
}  // namespace broadmark::tests
