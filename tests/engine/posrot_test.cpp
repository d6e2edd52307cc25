// .posrot recordings: the bytes, tight boxes against their definition, and invalid files.

#include "broadmark/recordings/posrot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "engine/recording_bytes.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::StartsWith;

constexpr float kHalfRoot = 0.70710678F;

SceneInfo posrotScene(std::uint32_t objects, std::uint32_t frames, const char* type = "Cubes") {
  return {"FreeFall", type, objects, frames, {{-8, -8, -8, 0}, {8, 8, 8, 0}}};
}

/// Two bodies and two frames, as bytes: a bar of 4 × 1 × 2 around (2, 0, 0), rotated by 0 and by
/// 90 degrees about z, and a unit cube around (0, 5, 0) that never rotates.
Bytes handMadePosrot(const char* type = "Cubes") {
  Bytes bytes(256);
  std::memcpy(bytes.data(), "FreeFall", 8);
  std::memcpy(bytes.data() + 128, type, std::strlen(type));
  bytes.insert(bytes.end(), {2, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  append(bytes, {-8, -8, -8, 0, 8, 8, 8, 0});
  append(bytes, {0, -0.5F, -1, 0, 4, 0.5F, 1, 0});
  append(bytes, {-0.5F, 4.5F, -0.5F, 0, 0.5F, 5.5F, 0.5F, 0});
  append(bytes, {2, 1, 0, 0, 0, 0, 0, 1});
  append(bytes, {0, 4, 0, 0, 0, 0, 0, 1});
  append(bytes, {2, 1, 0, 0, 0, 0, kHalfRoot, kHalfRoot});
  append(bytes, {0, 3, 0, 0, 0, 0, 0, -1});
  return bytes;
}

std::vector<Aabb> handMadeBoxes() {
  return {{{0, -0.5F, -1, 0}, {4, 0.5F, 1, 0}}, {{-0.5F, 4.5F, -0.5F, 0}, {0.5F, 5.5F, 0.5F, 0}}};
}

PosrotReader posrotOf(const Bytes& bytes) {
  return tests::readerOf<PosrotReader>(bytes, "test.posrot");
}
std::string posrotFault(const Bytes& bytes) {
  return tests::faultOf<PosrotReader>(bytes, "test.posrot");
}

/// `v` rotated by `q`, by the formula q v q*, in double.
std::array<double, 3> rotated(const std::array<double, 3>& v, const Quaternion& q) {
  const std::array<double, 3> u = {q[0], q[1], q[2]};
  const auto cross = [](const auto& a, const auto& b) {
    return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                 a[0] * b[1] - a[1] * b[0]};
  };
  const auto t = cross(u, v);
  const auto tt = cross(u, t);
  return {v[0] + 2 * (q[3] * t[0] + tt[0]), v[1] + 2 * (q[3] * t[1] + tt[1]),
          v[2] + 2 * (q[3] * t[2] + tt[2])};
}

/// The box around the eight rotated corners: the definition.
Aabb boxByCorners(const Vec3& half, const Pose& pose) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Aabb box{{kInfinity, kInfinity, kInfinity, 0}, {-kInfinity, -kInfinity, -kInfinity, 0}};
  for (int corner = 0; corner < 8; ++corner) {
    std::array<double, 3> v{};
    for (int axis = 0; axis < 3; ++axis) v[axis] = corner >> axis & 1 ? half[axis] : -half[axis];
    v = rotated(v, pose.rotation);
    for (int axis = 0; axis < 3; ++axis) {
      const auto x = static_cast<float>(pose.position[axis] + v[axis]);
      box.min[axis] = std::min(box.min[axis], x);
      box.max[axis] = std::max(box.max[axis], x);
    }
  }
  return box;
}

class RandomPoses {
 public:
  explicit RandomPoses(unsigned seed) : random_(seed) {}
  float uniform(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random_);
  }
  Pose pose(float reach) {
    Pose pose;
    for (float& x : pose.position) x = uniform(-reach, reach);
    float squared = 0;
    do {
      squared = 0;
      for (float& x : pose.rotation) {
        x = uniform(-1, 1);
        squared += x * x;
      }
    } while (squared < 0.01F || squared > 1);
    for (float& x : pose.rotation) x /= std::sqrt(squared);
    return pose;
  }

 private:
  std::mt19937 random_;
};

TEST(Posrot, IsReadByteForByte) {
  PosrotReader reader = posrotOf(handMadePosrot());
  EXPECT_EQ(reader.scene(), posrotScene(2, 2));
  EXPECT_THAT(reader.rewind().boxes, ElementsAreArray(handMadeBoxes()));
  EXPECT_THAT(reader.unrotatedBoxes(), ElementsAreArray(handMadeBoxes()));
  EXPECT_THAT(reader.halfExtents(), ElementsAreArray<Vec3>({{2, 0.5F, 1}, {0.5F, 0.5F, 0.5F}}));

  const auto first = reader.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->index, 1U);
  EXPECT_THAT(first->boxes,
              ElementsAreArray<Aabb>({{{0, 0.5F, -1, 0}, {4, 1.5F, 1, 0}},
                                      {{-0.5F, 3.5F, -0.5F, 0}, {0.5F, 4.5F, 0.5F, 0}}}));
  const auto second = reader.next();
  ASSERT_TRUE(second);
  EXPECT_THAT(reader.poses(), ElementsAreArray<Pose>({{{2, 1, 0}, {0, 0, kHalfRoot, kHalfRoot}},
                                                      {{0, 3, 0}, {0, 0, 0, -1}}}));
  expectNear(second->boxes[0], {{1.5F, -1, -1, 0}, {2.5F, 3, 1, 0}}, 1e-6F);
  EXPECT_EQ(second->boxes[1], (Aabb{{-0.5F, 2.5F, -0.5F, 0}, {0.5F, 3.5F, 0.5F, 0}}));
  EXPECT_FALSE(reader.next());
}

TEST(Posrot, IsWrittenByteForByte) {
  const TemporaryDirectory directory;
  PosrotWriter writer(directory / "a.posrot", posrotScene(2, 2));
  writer.writeBoxes(handMadeBoxes());
  PosrotReader reader = posrotOf(handMadePosrot());
  for (const std::uint32_t frame : {1U, 2U}) {
    reader.at(frame);
    writer.write(reader.poses());
  }
  const std::string hash = writer.finish();
  EXPECT_EQ(hash, reader.hash());
  std::ifstream file(directory / "a.posrot", std::ios::binary);
  EXPECT_EQ(Bytes(std::istreambuf_iterator<char>(file), {}), handMadePosrot());
}

TEST(Posrot, WhateverLiesInAPosesPaddingIsNotWritten) {
  const TemporaryDirectory directory;
  std::vector<Pose> poses(2);
  std::memset(static_cast<void*>(poses.data()), 0x41, 2 * sizeof(Pose));
  poses[0].position = {2, 1, 0};
  poses[1].position = {0, 4, 0};
  poses[0].rotation = poses[1].rotation = {0, 0, 0, 1};
  PosrotWriter writer(directory / "a.posrot", posrotScene(2, 1));
  writer.writeBoxes(handMadeBoxes());
  writer.write(poses);
  writer.finish();
  std::ifstream file(directory / "a.posrot", std::ios::binary);
  const Bytes bytes(std::istreambuf_iterator<char>(file), {});
  const Bytes expected = handMadePosrot();
  EXPECT_TRUE(std::equal(bytes.begin() + 304, bytes.end(), expected.begin() + 304));
}

TEST(Posrot, BoxesAreThoseAroundTheEightTurnedCorners) {
  constexpr std::uint32_t kBodies = 500;
  const TemporaryDirectory directory;
  RandomPoses random(3);
  std::vector<Aabb> unturned;
  std::vector<Vec3> halves;
  for (std::uint32_t i = 0; i < kBodies; ++i) {
    halves.push_back({random.uniform(0, 3), random.uniform(0, 3), random.uniform(0, 0.1F)});
    unturned.push_back(boxAround({}, halves.back()));
  }
  PosrotWriter writer(directory / "a.posrot", posrotScene(kBodies, 4, "Assorted"));
  writer.writeBoxes(unturned);
  std::vector<std::vector<Pose>> frames(5);
  for (std::size_t f = 1; f < frames.size(); ++f) {
    for (std::uint32_t i = 0; i < kBodies; ++i) frames[f].push_back(random.pose(8));
    writer.write(frames[f]);
  }
  writer.finish();

  PosrotReader reader(directory / "a.posrot");
  for (std::size_t f = 1; f < frames.size(); ++f) {
    const Frame frame = reader.at(static_cast<std::uint32_t>(f));
    for (std::uint32_t i = 0; i < kBodies; ++i) {
      SCOPED_TRACE(i);
      expectNear(frame.boxes[i], boxByCorners(halves[i], frames[f][i]), 4e-6F);
    }
  }
}

TEST(Posrot, BoxesOfSpheresDoNotDependOnTheRotation) {
  PosrotReader reader = posrotOf(handMadePosrot("Spheres"));
  const Frame frame = reader.at(2);
  EXPECT_EQ(frame.boxes[0], (Aabb{{0, 0.5F, -1, 0}, {4, 1.5F, 1, 0}}));
}

// Initial corners are rounded to multiples of about 2^-19 there; cubes must remain cubes.
TEST(Posrot, UsualSizesAreFoundExactlyFarFromTheOrigin) {
  RandomPoses random(5);
  std::vector<Aabb> unturned;
  std::vector<Vec3> halves;
  for (const float size : {0.5F, 0.95F, 7.6F, 0.2F, 1.9F, 0.05F, 0.125F}) {
    for (int i = 0; i < 200; ++i) {
      halves.push_back({size, size, size});
      unturned.push_back(boxAround(random.pose(110).position, halves.back()));
    }
  }
  const TemporaryDirectory directory;
  PosrotWriter writer(directory / "a.posrot",
                      posrotScene(static_cast<std::uint32_t>(unturned.size()), 0));
  writer.writeBoxes(unturned);
  writer.finish();
  PosrotReader reader(directory / "a.posrot");
  reader.rewind();
  EXPECT_THAT(reader.halfExtents(), ElementsAreArray(halves));
}

TEST(Posrot, UnusualSizesAreFoundUpToTheRoundingOfTheCorners) {
  RandomPoses random(6);
  std::vector<Aabb> unturned;
  std::vector<float> halves;
  for (int i = 0; i < 2000; ++i) {
    halves.push_back(random.uniform(1e-3F, 2));
    unturned.push_back(
        boxAround(random.pose(100).position, {halves.back(), halves.back(), halves.back()}));
  }
  const TemporaryDirectory directory;
  PosrotWriter writer(directory / "a.posrot", posrotScene(2000, 0));
  writer.writeBoxes(unturned);
  writer.finish();
  PosrotReader reader(directory / "a.posrot");
  reader.rewind();
  for (std::size_t i = 0; i < halves.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      // 2^-17 is the spacing of floats from 64 to 128.
      ASSERT_NEAR(reader.halfExtents()[i][axis], halves[i], 3 * 0x1p-17F) << i;
    }
  }
}

TEST(Posrot, ReadingAnywhereGoesOnFromThere) {
  PosrotReader reader = posrotOf(handMadePosrot());
  EXPECT_EQ(reader.at(1).index, 1U);
  reader.hash();
  EXPECT_EQ(reader.next()->index, 2U);
  EXPECT_THAT(reader.rewind().boxes, ElementsAreArray(handMadeBoxes()));
  EXPECT_THAT(inputErrorOf([&] { reader.at(3); }), HasSubstr("no frame 3"));
}

TEST(Posrot, NoBodiesOrNoFrames) {
  for (const auto& [objects, frames] : {std::pair{0U, 0U}, {0U, 3U}, {3U, 0U}}) {
    const TemporaryDirectory directory;
    PosrotWriter writer(directory / "a.posrot", posrotScene(objects, frames));
    writer.writeBoxes(chain(objects));
    for (std::uint32_t f = 0; f < frames; ++f) writer.write({});
    writer.finish();
    PosrotReader reader(directory / "a.posrot");
    EXPECT_EQ(reader.rewind().boxes.size(), objects);
    std::uint32_t count = 0;
    while (reader.next()) ++count;
    EXPECT_EQ(count, frames);
  }
}

TEST(Posrot, TheExtensionTellsTheKind) {
  const TemporaryDirectory directory;
  const Bytes bytes = handMadePosrot();
  for (const char* name : {"a.posrot", "a.aabbs", "a"}) {
    std::ofstream(directory / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  EXPECT_EQ(openRecordingFile(directory / "a.posrot")->at(1).boxes[1].max[1], 4.5F);
  // Poses read as boxes are invalid.
  for (const char* name : {"a.aabbs", "a"}) {
    EXPECT_THAT(inputErrorOf([&] { openRecordingFile(directory / name)->at(1); }),
                HasSubstr("the box is inverted"));
  }
}

TEST(PosrotWriter, LeavesNothingUnlessWhole) {
  const TemporaryDirectory directory;
  {
    PosrotWriter writer(directory / "a.posrot", posrotScene(2, 1));
    EXPECT_THROW(writer.writeBoxes(chain(3)), std::logic_error);
    writer.writeBoxes(chain(2));
    EXPECT_THROW(writer.write(std::vector<Pose>(1)), std::logic_error);
    EXPECT_THROW(writer.finish(), std::logic_error);
  }
  EXPECT_TRUE(directory.empty());
}

TEST(PosrotWriter, RefusesWhatNoReaderWouldTake) {
  const TemporaryDirectory directory;
  PosrotWriter writer(directory / "a.posrot", posrotScene(2, 1));
  std::vector<Aabb> boxes = chain(2);
  boxes[1].max[0] = -9;
  EXPECT_THAT(inputErrorOf([&] { writer.writeBoxes(boxes); }),
              HasSubstr("frame 0, body 1 (byte 336): the box is inverted"));
  writer.writeBoxes(chain(2));
  std::vector<Pose> poses(2);
  poses[1].rotation = {0, 0, 0, 0};
  EXPECT_THAT(inputErrorOf([&] { writer.write(poses); }),
              HasSubstr("frame 1, body 1 (byte 400): the pose has a quaternion of length 0"));
  writer.write(std::vector<Pose>(2));
  EXPECT_EQ(writer.finish().size(), 32U) << "the bad sets were not written";
}

TEST(BadPosrot, BrokenRecordsAreNamedWithTheirPlace) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kMax = std::numeric_limits<float>::max();
  // Frame 1 is at 304 + 32 · 2 = 368, frame 2 at 432.
  struct Fault {
    std::size_t offset;
    float value;
    const char* text;
  };
  const Fault faults[] = {
      {304, kNan, "frame 0, body 0 (byte 304): the box is not a number"},
      {340, 7, "frame 0, body 1 (byte 336): the box is inverted"},
      {368, kNan, "frame 1, body 0 (byte 368): the pose is not a number"},
      {408, -kInfinity, "frame 1, body 1 (byte 400): the pose is infinite"},
      {428, kNan, "frame 1, body 1 (byte 400): the pose is not a number"},
      {428, kInfinity, "frame 1, body 1 (byte 400): the pose is infinite"},
      {428, 0, "frame 1, body 1 (byte 400): the pose has a quaternion of length 0 (expected: 1)"},
      {428, 1.01F, "frame 1, body 1 (byte 400): the pose has a quaternion of length 1.01"},
      {460, kMax, "frame 2, body 0 (byte 432): the pose has a quaternion of length"},
      {272, kNan, "byte 272: the world box is not a number"}};
  for (const Fault& fault : faults) {
    Bytes bytes = handMadePosrot();
    putFloat(bytes, fault.offset, fault.value);
    EXPECT_THAT(posrotFault(bytes), AllOf(StartsWith("test.posrot: "), HasSubstr(fault.text)));
  }
}

TEST(BadPosrot, QuaternionsMayBeOffByATolerance) {
  Bytes bytes = handMadePosrot();
  putFloat(bytes, 428, 1 + kRotationTolerance / 3);
  EXPECT_EQ(posrotOf(bytes).at(1).boxes.size(), 2U);
  putFloat(bytes, 428, 1 + kRotationTolerance);
  EXPECT_THAT(posrotFault(bytes), HasSubstr("quaternion"));
}

TEST(BadPosrot, WrongLengthsAndCounts) {
  const Bytes whole = handMadePosrot();
  EXPECT_THAT(posrotFault({}), HasSubstr("too short"));
  for (const std::size_t size : {303, 304, 367, 400, 495}) {
    EXPECT_THAT(posrotFault(Bytes(whole.begin(), whole.begin() + size)), HasSubstr("too short"));
  }
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_THAT(posrotFault(longer), HasSubstr("497 bytes is too long"));
  Bytes wrong_count = whole;
  wrong_count[259] = 0x40;  // 2^30 + 2 objects
  EXPECT_THAT(posrotFault(wrong_count), HasSubstr("too short"));
  wrong_count[259] = 0xFF;
  EXPECT_THAT(posrotFault(wrong_count), HasSubstr("byte 256: negative number of bodies"));
}

}  // namespace
}  // namespace broadmark::tests
