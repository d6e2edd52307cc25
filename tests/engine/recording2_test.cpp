// .broadmark recordings: what is written comes back, in any order; and everything that may be wrong
// with a file.

#include "broadmark/recording2.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "broadmark/sub_recording.h"
#include "engine/recording_bytes.h"
#include "support/changing_worlds.h"
#include "support/inputs.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

using Frames = std::vector<std::vector<Aabb>>;

constexpr std::uint32_t kBodies = 60;

/// Boxes of which some change, come and go in each frame.
Frames changingFrames(std::uint32_t bodies, std::uint32_t frames, int share_of_changes,
                      bool all_present) {
  inputs::Random random(bodies, frames);
  Frames all(1);
  for (std::uint32_t body = 0; body < bodies; ++body) {
    all[0].push_back(inputs::boxAt(random.inCube(5), random.inCube(1)));
  }
  while (all.size() <= frames) {
    all.push_back(all.back());
    for (Aabb& box : all.back()) {
      if (random.integer(1, 100) > share_of_changes) continue;
      box = inputs::boxAt(random.inCube(5), random.inCube(1));
      if (!all_present && random.integer(0, 2) == 0) box = kEmptyBox;
    }
  }
  return all;
}

SceneInfo sceneOf(const Frames& frames, bool all_present = false, CollisionFilter filter = {}) {
  return {.name = "Changing",
          .object_type = "Boxes",
          .objects = static_cast<std::uint32_t>(frames[0].size()),
          .frames = static_cast<std::uint32_t>(frames.size() - 1),
          .world = unitBox(0),
          .all_present = all_present,
          .filter = std::move(filter)};
}

std::string write(const std::filesystem::path& path, const SceneInfo& scene, const Frames& frames,
                  const RecordingOrigin& origin = {}) {
  RecordingWriter writer(path, scene, origin);
  for (const auto& boxes : frames) writer.write(boxes);
  return writer.finish();
}

/// What Frame::changed has to be.
std::vector<std::uint32_t> changesIn(const Frames& frames, std::uint32_t frame) {
  std::vector<std::uint32_t> changed;
  for (std::uint32_t body = 0; frame > 0 && body < frames[frame].size(); ++body) {
    if (frames[frame][body] != frames[frame - 1][body]) changed.push_back(body);
  }
  return changed;
}

void expectFrame(const Frame& frame, const Frames& frames, std::uint32_t index) {
  EXPECT_EQ(frame.index, index);
  EXPECT_THAT(frame.boxes, ElementsAreArray(frames[index])) << "frame " << index;
  ASSERT_TRUE(frame.changed);
  EXPECT_THAT(*frame.changed, ElementsAreArray(changesIn(frames, index))) << "frame " << index;
}

TEST(Recording2, WhatIsWrittenIsReadBackInAnyOrder) {
  const TemporaryDirectory directory;
  for (const bool all_present : {true, false}) {
    for (const int share : {0, 2, 30, 100}) {
      const Frames frames = changingFrames(kBodies, 40, share, all_present);
      const SceneInfo scene = sceneOf(frames, all_present);
      const auto path = directory / "a.broadmark";
      const std::string hash = write(path, scene, frames);

      Recording2Reader reader(path);
      EXPECT_EQ(reader.scene(), scene);
      EXPECT_EQ(reader.hash(), hash);
      EXPECT_EQ(reader.bytes(), std::filesystem::file_size(path));
      for (int pass = 0; pass < 2; ++pass) {
        expectFrame(reader.rewind(), frames, 0);
        for (std::uint32_t f = 1; f <= 40; ++f) expectFrame(reader.next().value(), frames, f);
        EXPECT_FALSE(reader.next());
      }
      inputs::Random random(1, 1);
      for (int i = 0; i < 300; ++i) {
        const auto f = static_cast<std::uint32_t>(random.integer(0, 40));
        expectFrame(reader.at(f), frames, f);
        if (i % 7 == 0) expectFrame(reader.at(f), frames, f);
      }
    }
  }
}

TEST(Recording2, KeepsWhatPairsAreWanted) {
  const TemporaryDirectory directory;
  const Frames frames = changingFrames(kBodies, 3, 10, false);
  for (const auto& [name, filter] : filters(kBodies)) {
    const SceneInfo scene = sceneOf(frames, true, filter);
    const auto path = directory / "a.broadmark";
    if (!filter.wantsAll()) {
      EXPECT_EQ(recordingExtension(scene), ".broadmark");
      EXPECT_THAT(inputErrorOf([&] { write(directory / "a.aabbs", scene, frames); }),
                  AllOf(HasSubstr("a.aabbs"), HasSubstr(".broadmark")));
    }
    const SceneInfo changing = sceneOf(frames, false, filter);
    write(path, changing, frames);
    EXPECT_EQ(Recording2Reader(path).scene(), changing) << name;
  }
}

TEST(Recording2, SaysWhereItComesFrom) {
  const TemporaryDirectory directory;
  const Frames frames = changingFrames(3, 1, 10, true);
  const RecordingOrigin origin = {"city.csv", "{\n \"scene\": \"city\"\n}\n"};
  write(directory / "a.broadmark", sceneOf(frames), frames, origin);
  EXPECT_EQ(Recording2Reader(directory / "a.broadmark").origin(), origin);
  write(directory / "b.broadmark", sceneOf(frames), frames);
  EXPECT_EQ(openRecordingFile(directory / "b.broadmark")->origin(), RecordingOrigin());
}

TEST(Recording2, NoBodiesOrNoFrames) {
  for (const auto& [bodies, count] :
       std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 0}, {0, 7}, {3, 0}, {1, 600}}) {
    const Frames frames = changingFrames(bodies, count, 0, true);
    RecordingWriter writer(sceneOf(frames));
    for (const auto& boxes : frames) writer.write(boxes);
    const auto reader = writer.finishTemporary();
    EXPECT_EQ(reader->scene(), sceneOf(frames));
    expectFrame(reader->at(count), frames, count);
    expectFrame(reader->rewind(), frames, 0);
  }
}

TEST(Recording2, AStillWorldIsSmall) {
  const TemporaryDirectory directory;
  const Frames still(101, changingFrames(1000, 0, 0, true)[0]);
  write(directory / "a.broadmark", sceneOf(still, true), still);
  write(directory / "a.aabbs", sceneOf(still, true), still);
  EXPECT_LT(std::filesystem::file_size(directory / "a.broadmark"),
            std::filesystem::file_size(directory / "a.aabbs") / 90);
  const Frames moving = changingFrames(1000, 100, 100, true);
  write(directory / "b.broadmark", sceneOf(moving, true), moving);
  EXPECT_LT(std::filesystem::file_size(directory / "b.broadmark"),
            std::filesystem::file_size(directory / "a.aabbs") * 4 / 5);
}

// To the bit: what is converted back is the same file.
TEST(Recording2, TellsZeroesApart) {
  const TemporaryDirectory directory;
  Frames frames(3, {Aabb{{0, 0, 0, 0}, {1, 1, 1, 0}}});
  frames[1][0].min[1] = -0.0F;
  write(directory / "a.broadmark", sceneOf(frames), frames);
  Recording2Reader reader(directory / "a.broadmark");
  EXPECT_FALSE(std::signbit(reader.at(0).boxes[0].min[1]));
  EXPECT_TRUE(std::signbit(reader.at(2).boxes[0].min[1]));
}

TEST(Recording2, PartsKeepWhoIsThereAndWhatIsWanted) {
  const TemporaryDirectory directory;
  const Frames frames = changingFrames(kBodies, 9, 40, false);
  const CollisionFilter filter = filters(kBodies)[1].filter;
  write(directory / "a.broadmark", sceneOf(frames, false, filter), frames);
  Recording2Reader whole(directory / "a.broadmark");
  const Part part{.bodies = {1, 5, 30, 31, 59}, .frames = {2, 3, 7}};
  writePart(directory / "b.broadmark", whole, part);
  Recording2Reader reader(directory / "b.broadmark");
  EXPECT_EQ(reader.scene().filter, filter.of(part.bodies));
  Frames expected;
  for (const std::uint32_t frame : part.frames) {
    expected.emplace_back();
    for (const std::uint32_t body : part.bodies) expected.back().push_back(frames[frame][body]);
  }
  for (std::uint32_t f = 0; f < 3; ++f) expectFrame(reader.at(f), expected, f);
}

TEST(Recording2, IsTakenOnlyWhereAabbsDoesNotDo) {
  const Frames frames = changingFrames(2, 1, 0, true);
  EXPECT_EQ(recordingFileName(sceneOf(frames, true)), "Changing Boxes N2 F1frames.aabbs");
  EXPECT_EQ(recordingFileName(sceneOf(frames, false)), "Changing Boxes N2 F1frames.broadmark");
  EXPECT_THAT(recordingExtensions(), ElementsAre(".aabbs", ".broadmark", ".posrot"));
  EXPECT_THAT(inputErrorOf([&] { RecordingWriter writer("a.posrot", sceneOf(frames)); }),
              AllOf(HasSubstr("a.posrot"), HasSubstr(".aabbs or .broadmark")));
}

TEST(Recording2Writer, LeavesNothingUnlessFinished) {
  const TemporaryDirectory directory;
  const Frames frames = changingFrames(2, 1, 0, true);
  {
    RecordingWriter writer(directory / "a.broadmark", sceneOf(frames));
    writer.write(frames[0]);
    EXPECT_THROW(writer.write(chain(3)), std::logic_error);
    EXPECT_THROW(writer.finish(), std::logic_error);
    EXPECT_FALSE(std::filesystem::exists(directory / "a.broadmark"));
  }
  EXPECT_TRUE(directory.empty());
}

TEST(Recording2Writer, RefusesBoxesThatNoReaderWouldTake) {
  const Frames frames = changingFrames(2, 1, 0, true);
  RecordingWriter writer(SceneInfo{.objects = 2, .frames = 1, .all_present = false});
  std::vector<Aabb> boxes = frames[0];
  boxes[1].max[2] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(inputErrorOf([&] { writer.write(boxes); }),
              HasSubstr("frame 0, body 1: the box is infinite"));
  boxes[1] = kEmptyBox;
  writer.write(boxes);
  writer.write(boxes);
  EXPECT_EQ(writer.finishTemporary()->at(1).boxes[1], kEmptyBox);

  const TemporaryDirectory directory;
  RecordingWriter full(directory / "a.broadmark", sceneOf(frames, true));
  EXPECT_THAT(inputErrorOf([&] { full.write(boxes); }), HasSubstr("all are present"));
}

}  // namespace
}  // namespace broadmark::tests
