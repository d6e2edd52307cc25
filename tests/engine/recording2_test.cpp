// .broadmark recordings: written frames are read back in any order; and all kinds of invalid files.

#include "broadmark/recordings/recording2.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "broadmark/recordings/sub_recording.h"
#include "engine/recording_bytes.h"
#include "support/changing_worlds.h"
#include "torture/inputs.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

using Frames = std::vector<std::vector<Aabb>>;

constexpr std::uint32_t kSlots = 60;

/// Frames in which some boxes change, appear and vanish.
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

SceneInfo changingSceneOf(const Frames& frames, bool all_present = false,
                          CollisionFilter filter = {}) {
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

/// The expected value of Frame::changed.
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
      const Frames frames = changingFrames(kSlots, 40, share, all_present);
      const SceneInfo scene = changingSceneOf(frames, all_present);
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
  const Frames frames = changingFrames(kSlots, 3, 10, false);
  for (const auto& [name, filter] : filters(kSlots)) {
    const SceneInfo scene = changingSceneOf(frames, true, filter);
    const auto path = directory / "a.broadmark";
    if (!filter.wantsAll()) {
      EXPECT_EQ(recordingExtension(scene), ".broadmark");
      EXPECT_THAT(inputErrorOf([&] { write(directory / "a.aabbs", scene, frames); }),
                  AllOf(HasSubstr("a.aabbs"), HasSubstr(".broadmark")));
    }
    const SceneInfo changing = changingSceneOf(frames, false, filter);
    write(path, changing, frames);
    EXPECT_EQ(Recording2Reader(path).scene(), changing) << name;
  }
}

TEST(Recording2, SaysWhereItComesFrom) {
  const TemporaryDirectory directory;
  const Frames frames = changingFrames(3, 1, 10, true);
  const RecordingOrigin origin = {"city.csv", "{\n \"scene\": \"city\"\n}\n"};
  write(directory / "a.broadmark", changingSceneOf(frames), frames, origin);
  EXPECT_EQ(Recording2Reader(directory / "a.broadmark").origin(), origin);
  write(directory / "b.broadmark", changingSceneOf(frames), frames);
  EXPECT_EQ(openRecordingFile(directory / "b.broadmark")->origin(), RecordingOrigin());
}

TEST(Recording2, NoBodiesOrNoFrames) {
  for (const auto& [bodies, count] :
       std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 0}, {0, 7}, {3, 0}, {1, 600}}) {
    const Frames frames = changingFrames(bodies, count, 0, true);
    RecordingWriter writer(changingSceneOf(frames));
    for (const auto& boxes : frames) writer.write(boxes);
    const auto reader = writer.finishTemporary();
    EXPECT_EQ(reader->scene(), changingSceneOf(frames));
    expectFrame(reader->at(count), frames, count);
    expectFrame(reader->rewind(), frames, 0);
  }
}

TEST(Recording2, AStillWorldIsSmall) {
  const TemporaryDirectory directory;
  const Frames still(101, changingFrames(1000, 0, 0, true)[0]);
  write(directory / "a.broadmark", changingSceneOf(still, true), still);
  write(directory / "a.aabbs", changingSceneOf(still, true), still);
  EXPECT_LT(std::filesystem::file_size(directory / "a.broadmark"),
            std::filesystem::file_size(directory / "a.aabbs") / 90);
  const Frames moving = changingFrames(1000, 100, 100, true);
  write(directory / "b.broadmark", changingSceneOf(moving, true), moving);
  EXPECT_LT(std::filesystem::file_size(directory / "b.broadmark"),
            std::filesystem::file_size(directory / "a.aabbs") * 4 / 5);
}

// Bits are preserved, so that a file converted back is identical.
TEST(Recording2, TellsZeroesApart) {
  const TemporaryDirectory directory;
  Frames frames(3, {Aabb{{0, 0, 0, 0}, {1, 1, 1, 0}}});
  frames[1][0].min[1] = -0.0F;
  write(directory / "a.broadmark", changingSceneOf(frames), frames);
  Recording2Reader reader(directory / "a.broadmark");
  EXPECT_FALSE(std::signbit(reader.at(0).boxes[0].min[1]));
  EXPECT_TRUE(std::signbit(reader.at(1).boxes[0].min[1]));
  EXPECT_FALSE(std::signbit(reader.at(2).boxes[0].min[1]));
}

TEST(Recording2, PartsKeepWhoIsThereAndWhatIsWanted) {
  const TemporaryDirectory directory;
  const Frames frames = changingFrames(kSlots, 9, 40, false);
  const CollisionFilter filter = filters(kSlots)[1].filter;
  write(directory / "a.broadmark", changingSceneOf(frames, false, filter), frames);
  Recording2Reader whole(directory / "a.broadmark");
  const Selection part = selectionOf(whole.scene(), {1, 5, 30, 31, 59}, {2, 3, 7});
  writeSelection(directory / "b.broadmark", whole, part);
  Recording2Reader reader(directory / "b.broadmark");
  EXPECT_EQ(reader.scene().filter, filter.of(part.bodies));
  Frames expected;
  for (const std::uint32_t frame : part.frames) {
    expected.emplace_back();
    for (const std::uint32_t body : part.bodies) expected.back().push_back(frames[frame][body]);
  }
  for (std::uint32_t f = 0; f < 3; ++f) expectFrame(reader.at(f), expected, f);
}

/// Writes frames with these filters.
void write(const std::filesystem::path& path, const Frames& frames,
           const std::vector<CollisionFilter>& filters) {
  FrameList source = listed(changingSceneOf(frames), frames, filters);
  RecordingWriter writer(path, source.scene());
  recordAll(source, writer);
  writer.finish();
}

TEST(Recording2, KeepsFiltersThatChange) {
  const TemporaryDirectory directory;
  const auto path = directory / "a.broadmark";
  for (const std::uint32_t last : {30U, 300U}) {  // more than one key frame at rest
    const Frames frames = changingFrames(kSlots, last, last == 30 ? 30 : 0, false);
    for (const auto& [change_name, changes] : inputs::kFilterChanges) {
      for (const std::size_t kind : {std::size_t{0}, filters(kSlots).size() - 1}) {
        SCOPED_TRACE(fmt::format("{} {} {}", last, change_name, kind));
        const auto all =
            inputs::changingFilters(filters(kSlots)[kind].filter, kSlots, last, changes, last);
        write(path, frames, all);
        Recording2Reader reader(path);
        EXPECT_TRUE(reader.scene().filter_changes);
        EXPECT_EQ(reader.scene().filter, all[0]);
        const auto expect = [&](const Frame& frame, std::uint32_t index) {
          expectFrame(frame, frames, index);
          ASSERT_NE(frame.filter, nullptr);
          EXPECT_EQ(*frame.filter, all[index]);
          std::vector<std::uint32_t> changed;
          for (std::uint32_t body = 0; index > 0 && body < kSlots; ++body) {
            if (all[index].groupsOf(body) != all[index - 1].groupsOf(body)) changed.push_back(body);
          }
          EXPECT_THAT(frame.filter_changed, ElementsAreArray(changed)) << index;
        };
        expect(reader.rewind(), 0);
        for (std::uint32_t index = 1; index <= last; ++index) expect(*reader.next(), index);
        inputs::Random random(1, last);
        for (int i = 0; i < 60; ++i) {
          const auto index = static_cast<std::uint32_t>(random.integer(0, static_cast<int>(last)));
          expect(reader.at(index), index);
        }
      }
    }
  }
}

TEST(Recording2, FiltersThatChangeNeedAReaderThatKnowsThem) {
  const TemporaryDirectory directory;
  const auto path = directory / "a.broadmark";
  const Frames frames = changingFrames(kSlots, 3, 0, true);
  const auto all = inputs::changingFilters({}, kSlots, 3, inputs::filter_changes::half, 1);
  write(path, frames, all);
  EXPECT_THAT(readTextFile(path), HasSubstr("\"broadmark-recording/2.1\""));
  write(path, changingSceneOf(frames, true), frames);
  EXPECT_THAT(readTextFile(path), HasSubstr("\"broadmark-recording/2\""));
  FrameList source = listed(changingSceneOf(frames, true), frames, all);
  EXPECT_EQ(recordingExtension(source.scene()), ".broadmark");
  EXPECT_THAT(inputErrorOf([&] { RecordingWriter(directory / "a.aabbs", source.scene()); }),
              HasSubstr(".broadmark ones do"));
}

TEST(Recording2, KeepsAPeriodicBox) {
  const TemporaryDirectory directory;
  const auto path = directory / "a.broadmark";
  const Frames frames = changingFrames(kSlots, 3, 0, true);
  SceneInfo scene = changingSceneOf(frames, true);
  scene.periodic = {{0.1, 0, -5}, {10, 0, 1e9}};
  EXPECT_EQ(recordingExtension(scene), ".broadmark");
  write(path, scene, frames);
  EXPECT_THAT(readTextFile(path), HasSubstr("\"broadmark-recording/2.2\""));
  EXPECT_EQ(Recording2Reader(path).scene(), scene);

  const auto all = inputs::changingFilters({}, kSlots, 3, inputs::filter_changes::half, 1);
  FrameList source = listed(scene, frames, all);
  RecordingWriter writer(path, source.scene());
  writer.write(source.rewind());
  while (const auto frame = source.next()) writer.write(*frame);
  writer.finish();
  Recording2Reader reader(path);
  EXPECT_EQ(reader.scene().periodic, scene.periodic);
  EXPECT_TRUE(reader.scene().filter_changes);
  EXPECT_EQ(*reader.at(3).filter, all[3]);
}

TEST(Recording2, WritesOnlyFiltersThatTheSceneAnnounces) {
  const TemporaryDirectory directory;
  const auto path = directory / "a.broadmark";
  const Frames frames = changingFrames(4, 1, 0, true);
  const CollisionFilter first(std::vector<BodyGroups>(4), LayerMatrix().set(0, 0).set(0, 1), true);
  const std::vector<std::uint32_t> one = {2};
  const CollisionFilter next = first.with(one, std::vector{BodyGroups{.layer = 1}}, 4);
  SceneInfo scene = changingSceneOf(frames, true, first);
  const auto write_both = [&](const CollisionFilter& a, const CollisionFilter& b) {
    RecordingWriter writer(path, scene);
    writer.write({0, frames[0], {}, &a});
    writer.write({1, frames[1], {}, &b});
    writer.finish();
  };
  EXPECT_THROW(write_both(first, next), std::logic_error) << "not said to change";
  scene.filter_changes = true;
  EXPECT_NO_THROW(write_both(first, next));
  EXPECT_EQ(*Recording2Reader(path).at(1).filter, next);
  EXPECT_THROW(write_both(next, next), std::logic_error) << "another initial filter";
  EXPECT_THROW(write_both(first, CollisionFilter()), std::logic_error) << "another matrix";
}

TEST(Recording2, IsTakenOnlyWhereAabbsDoesNotDo) {
  const Frames frames = changingFrames(2, 1, 0, true);
  EXPECT_EQ(recordingFileName(changingSceneOf(frames, true)), "Changing Boxes N2 F1frames.aabbs");
  EXPECT_EQ(recordingFileName(changingSceneOf(frames, false)),
            "Changing Boxes N2 F1frames.broadmark");
  EXPECT_THAT(recordingExtensions(), ElementsAre(".aabbs", ".broadmark", ".posrot"));
  EXPECT_THAT(inputErrorOf([&] { RecordingWriter writer("a.posrot", changingSceneOf(frames)); }),
              AllOf(HasSubstr("a.posrot"), HasSubstr(".aabbs or .broadmark")));
}

/// Frame 0 has bodies 0 to 2; in frame 1 body 1 moves, in frame 2 body 2 vanishes.
Bytes smallRecording() {
  const TemporaryDirectory directory;
  Frames frames(1, chain(3));
  frames.push_back(frames[0]);
  frames[1][1] = unitBox(5);
  frames.push_back(frames[1]);
  frames[2][2] = kEmptyBox;
  write(directory / "a.broadmark", changingSceneOf(frames, false, filters(3)[1].filter), frames);
  return bytesOf(directory / "a.broadmark");
}

/// In frame 1 bodies 0 and 2 change; frame 2 is a key frame with a new filter of body 1.
Bytes smallRecordingWithFilters() {
  const TemporaryDirectory directory;
  Frames frames(3, chain(3));
  for (Aabb& box : frames[2]) box = unitBox(7);
  const CollisionFilter first(std::vector<BodyGroups>(3), LayerMatrix().set(0, 0).set(0, 1), true);
  const BodyGroups groups{.layer = 1, .tags = {4, 5, 6}};
  std::vector filters = {first};
  filters.push_back(first.with(std::vector{0U, 2U}, std::vector(2, groups), 3));
  filters.push_back(filters[1].with(std::vector{1U}, std::vector(1, groups), 3));
  write(directory / "a.broadmark", frames, filters);
  return bytesOf(directory / "a.broadmark");
}

Recording2Reader readerOf(const Bytes& bytes) {
  return tests::readerOf<Recording2Reader>(bytes, "test.broadmark");
}
std::string faultOf(const Bytes& bytes) {
  return tests::faultOf<Recording2Reader>(bytes, "test.broadmark");
}

template <class T>
T get(const Bytes& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

template <class T>
void put(Bytes& bytes, std::size_t offset, T value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

constexpr std::size_t kEntryBytes = 32;

std::size_t indexOf(const Bytes& bytes) {
  return get<std::uint64_t>(bytes, bytes.size() - kEntryBytes);
}
std::size_t frameOf(const Bytes& bytes, std::uint32_t frame) {
  return get<RecordedFrame>(bytes, indexOf(bytes) + kEntryBytes * frame).offset;
}

/// Corrects the checksums of spoilt bytes, as another writer would.
Bytes sealed(Bytes bytes) {
  const std::size_t index = indexOf(bytes);
  // Up to seven numbers of changed filters precede the index.
  constexpr std::string_view kFilterChanges = "broadmark-recording/2.1";
  const bool has_filters = !std::ranges::search(bytes, kFilterChanges).empty();
  const std::size_t frames_end = has_filters ? index - kEntryBytes : index;
  const auto raw = std::as_bytes(std::span(bytes));
  for (std::size_t offset = index; offset + kEntryBytes < bytes.size(); offset += kEntryBytes) {
    auto entry = get<RecordedFrame>(bytes, offset);
    const std::size_t end = offset + 2 * kEntryBytes < bytes.size()
                                ? get<RecordedFrame>(bytes, offset + kEntryBytes).offset
                                : frames_end;
    entry.hash = hashOf(raw.subspan(entry.offset, end - entry.offset));
    put(bytes, offset, entry);
  }
  Hasher hasher;
  hasher.add(raw.first(frameOf(bytes, 0)));
  hasher.add(raw.subspan(frames_end, bytes.size() - kEntryBytes - frames_end));
  put(bytes, bytes.size() - 24, hasher.value());
  return bytes;
}

/// Replaces a text in the header by another text of the same length.
Bytes withHeader(Bytes bytes, std::string_view text, std::string_view other) {
  const auto found = std::search(bytes.begin(), bytes.end(), text.begin(), text.end());
  EXPECT_EQ(text.size(), other.size());
  EXPECT_NE(found, bytes.end()) << text;
  if (found != bytes.end()) std::ranges::copy(other, found);
  return sealed(std::move(bytes));
}

TEST(BadRecording2, TooShortOrTooLong) {
  const Bytes whole = smallRecording();
  EXPECT_EQ(readerOf(whole).at(2).boxes[2], kEmptyBox);
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    EXPECT_THAT(faultOf(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))),
                StartsWith("test.broadmark: "));
  }
  Bytes longer = whole;
  longer.insert(longer.end(), 32, 0);
  EXPECT_THAT(faultOf(longer), HasSubstr("does not end as a .broadmark recording"));
}

TEST(BadRecording2, AnyWrongByteIsNoticed) {
  for (const Bytes& whole : {smallRecording(), smallRecordingWithFilters()}) {
    for (std::size_t at = 0; at < whole.size(); ++at) {
      Bytes bytes = whole;
      bytes[at] ^= 0x10;
      EXPECT_THAT(faultOf(bytes), StartsWith("test.broadmark: ")) << "byte " << at;
    }
  }
}

TEST(BadRecording2, FiltersAreNamedWithTheirBody) {
  const Bytes whole = smallRecordingWithFilters();
  EXPECT_EQ(readerOf(sealed(whole)).at(2).filter_changed.size(), 1U);
  const auto spoilt = [&](std::uint32_t frame, std::size_t offset, auto value) {
    Bytes bytes = whole;
    put(bytes, frameOf(bytes, frame) + offset, value);
    return faultOf(sealed(std::move(bytes)));
  };
  // Frame 1 has no boxes. Frame 2: boxes, the id, then all layers and tags.
  EXPECT_THAT(spoilt(1, 4, 9U), AllOf(HasSubstr("frame 1"), HasSubstr("body 9 among")));
  EXPECT_THAT(spoilt(1, 4, 0U), AllOf(HasSubstr("frame 1"), HasSubstr("ascend")));
  EXPECT_THAT(spoilt(1, 32 + 16, 32U), HasSubstr("frame 1, body 2: is in layer 32"));
  EXPECT_THAT(spoilt(2, 96 + 32 + 16, 77U), HasSubstr("frame 2, body 1: is in layer 77"));
  EXPECT_THAT(spoilt(2, 96 + 32 + 4, 8U), AllOf(HasSubstr("frame 2, body 0"), HasSubstr("tags")))
      << "not among the changed ones";
  // A number of changes that the frames do not have.
  Bytes bytes = whole;
  put(bytes, indexOf(bytes) - kEntryBytes + 8, 3U);
  EXPECT_THAT(faultOf(sealed(bytes)), HasSubstr("the frames end at byte"));
  put(bytes, indexOf(bytes) - kEntryBytes + 8, 4U);
  EXPECT_THAT(faultOf(sealed(bytes)), HasSubstr("4 changed filters"));
}

TEST(BadRecording2, DamagedFramesAreNamed) {
  Bytes bytes = smallRecording();
  const std::size_t at = frameOf(bytes, 1);
  bytes[at + 40] ^= 1;
  EXPECT_THAT(faultOf(bytes), HasSubstr("frame 1 (bytes " + std::to_string(at) + " to " +
                                        std::to_string(at + 63) + "): damaged"));
  EXPECT_THAT(inputErrorOf([&] { readerOf(bytes).at(2); }), HasSubstr("frame 1"));
  EXPECT_EQ(readerOf(bytes).at(0).boxes.size(), 3U);
  bytes[at] = 99;  // also with an invalid id
  EXPECT_THAT(faultOf(bytes), HasSubstr("damaged"));
}

TEST(BadRecording2, IdsAndBoxesAreNamedWithTheirPlace) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const Bytes whole = smallRecording();
  const auto spoilt = [&](std::uint32_t frame, std::size_t offset, auto value) {
    Bytes bytes = whole;
    put(bytes, frameOf(bytes, frame) + offset, value);
    return faultOf(sealed(std::move(bytes)));
  };
  const auto byte = [&](std::uint32_t frame, std::size_t offset) {
    return "byte " + std::to_string(frameOf(whole, frame) + offset);
  };
  EXPECT_THAT(spoilt(1, 0, 3U), AllOf(HasSubstr("frame 1, " + byte(1, 0)), HasSubstr("body 3"),
                                      HasSubstr("below 3")));
  EXPECT_THAT(spoilt(1, 32, kNan),
              HasSubstr("frame 1, body 1 (" + byte(1, 32) + "): the box is not a number"));
  EXPECT_THAT(spoilt(1, 44, kInfinity), HasSubstr("frame 1, body 1 (" + byte(1, 32)));
  EXPECT_THAT(spoilt(2, 32, 1.0F), HasSubstr("frame 2, body 2 (" + byte(2, 32)))
      << "neither present nor absent";
  EXPECT_THAT(spoilt(0, 28, 9.0F),
              HasSubstr("frame 0, body 1 (" + byte(0, 24) + "): the box is inverted"));
}

TEST(BadRecording2, AFrameThatWasReadHalfwayIsForgotten) {
  const TemporaryDirectory directory;
  Frames frames(3, chain(40));
  for (const int body : {3, 7}) frames[2][body] = unitBox(9);
  write(directory / "a.broadmark", changingSceneOf(frames), frames);
  Bytes bytes = bytesOf(directory / "a.broadmark");
  put(bytes, frameOf(bytes, 2) + 32 + 24, std::numeric_limits<float>::infinity());
  Recording2Reader reader = readerOf(sealed(bytes));
  expectFrame(reader.at(1), frames, 1);
  EXPECT_THAT(inputErrorOf([&] { reader.next(); }), HasSubstr("frame 2, body 7"));
  expectFrame(reader.at(1), frames, 1);
}

TEST(BadRecording2, IdsAscend) {
  const TemporaryDirectory directory;
  Frames frames(2, chain(40));
  frames[1][3] = unitBox(9);
  frames[1][7] = unitBox(9);
  write(directory / "a.broadmark", changingSceneOf(frames), frames);
  Bytes bytes = bytesOf(directory / "a.broadmark");
  put(bytes, frameOf(bytes, 1) + 4, 3U);
  EXPECT_THAT(faultOf(sealed(bytes)), HasSubstr("body 3 among the changed ones"));
  put(bytes, frameOf(bytes, 1) + 4, 2U);
  EXPECT_THAT(faultOf(sealed(bytes)), HasSubstr("body 2 among the changed ones"));
}

// An unlisted change would make incremental algorithms miss pairs.
TEST(BadRecording2, AKeyFrameChangesOnlyWhatItNames) {
  const TemporaryDirectory directory;
  Frames frames(3, chain(4));
  for (int body = 0; body < 3; ++body) frames[2][body] = unitBox(9);
  for (int body = 1; body < 4; ++body) frames[1][body] = unitBox(7);
  frames[2][3] = frames[1][3];
  write(directory / "a.broadmark", changingSceneOf(frames), frames);
  Bytes bytes = bytesOf(directory / "a.broadmark");
  const auto entry = get<RecordedFrame>(bytes, indexOf(bytes) + 2 * kEntryBytes);
  ASSERT_EQ(entry.key, 2U);
  ASSERT_EQ(entry.changed, 3U);
  put(bytes, frameOf(bytes, 2) + 32 + 3 * 24, 7.5F);
  bytes = sealed(bytes);
  EXPECT_THAT(faultOf(bytes),
              AllOf(HasSubstr("frame 2, body 3"), HasSubstr("not among the changed")));
}

TEST(BadRecording2, HeadersOfOtherThings) {
  const Bytes whole = smallRecording();
  const std::pair<std::string_view, std::string_view> replacements[] = {
      {"broadmark-recording/2", "broadmark-recording/3"},
      {"\"objects\": 3", "\"objects\": 9"},
      {"\"objects\": 3", "\"objects\":-3"},
      {"\"frames\": 2", "\"frames\": 9"},
      {"\"frames\": 2", "\"frames\": 1"},
      {"\"frames\": 2", "\"frames\":\"\""},
      {"\"all_present\": false", "\"all_present\": 0    "},
      {"\"Changing\"", "\"Chang\\ng\""},
      {"\"Changing\"", "\"Ch\\u0001\""},
      {"\"groups\"", "\"gruops\""},
      {"\"layers\"", "\"nobody\""},
      {"\"world\"", "\"earth\""},
      {"\"source\": null", "\"source\": 1234"},
      {"\"scene_parameters\": null", "\"scene_parameters\": 1234"},
      {"{", "["},
  };
  for (const auto& [text, other] : replacements) {
    EXPECT_THAT(faultOf(withHeader(whole, text, other)), StartsWith("test.broadmark: "))
        << text << " -> " << other;
  }
}

TEST(BadRecording2, AbsurdCountsTakeNoMemory) {
  Bytes bytes = smallRecording();
  put(bytes, 8, std::uint64_t{1} << 62);
  EXPECT_THAT(faultOf(bytes),
              HasSubstr("byte 8: invalid header size of 4611686018427387904 bytes"));
  bytes = smallRecording();
  bytes = withHeader(bytes, "\"objects\": 3,\n", "\"objects\":42e8");
  EXPECT_THAT(faultOf(bytes), StartsWith("test.broadmark: "));
  bytes = smallRecording();
  put(bytes, indexOf(bytes) + 8, std::numeric_limits<std::uint32_t>::max());
  EXPECT_THAT(faultOf(sealed(bytes)), HasSubstr("index: frame 0 cannot be"));
}

TEST(BadRecording2, AnIndexThatLeadsNowhere) {
  const Bytes whole = smallRecording();
  const std::size_t entry = indexOf(whole) + kEntryBytes;
  const auto spoilt = [&](int offset, auto value) {
    Bytes bytes = whole;
    put(bytes, entry + static_cast<std::size_t>(offset), value);
    Hasher hasher;  // of the spoilt index
    hasher.add(std::as_bytes(std::span(bytes)).first(frameOf(whole, 0)));
    hasher.add(std::as_bytes(std::span(bytes)).subspan(indexOf(whole), 3 * kEntryBytes));
    put(bytes, bytes.size() - 24, hasher.value());
    return faultOf(bytes);
  };
  EXPECT_THAT(spoilt(0, std::uint64_t{7}), HasSubstr("index: frame 1"));
  EXPECT_THAT(spoilt(0, std::uint64_t{1} << 63), HasSubstr("index: frame 1"));
  EXPECT_THAT(spoilt(8, 0U), HasSubstr("index: frame 2"));
  EXPECT_THAT(spoilt(8, 4U), HasSubstr("index: frame 1"));
  EXPECT_THAT(spoilt(12, 2U), HasSubstr("index: frame 1"));
  EXPECT_THAT(spoilt(12, 1U), HasSubstr("index: frame 2"));
  EXPECT_THAT(spoilt(-20, 1U), HasSubstr("index: frame 0")) << "the first frame is a key frame";
}

TEST(Recording2Writer, LeavesNothingUnlessFinished) {
  const TemporaryDirectory directory;
  const Frames frames = changingFrames(2, 1, 0, true);
  {
    RecordingWriter writer(directory / "a.broadmark", changingSceneOf(frames));
    writer.write(frames[0]);
    EXPECT_THROW(writer.write(chain(3)), std::logic_error);
    EXPECT_THROW(writer.finish(), std::logic_error);
    EXPECT_FALSE(std::filesystem::exists(directory / "a.broadmark"));
  }
  EXPECT_TRUE(directory.empty());
}

TEST(Recording2Writer, TakesASourcesWordForWhatChanged) {
  const TemporaryDirectory directory;
  for (const int share : {0, 2, 100}) {
    const Frames frames = changingFrames(kSlots, 40, share, false);
    const SceneInfo scene = changingSceneOf(frames);
    RecordingWriter writer(directory / "told.broadmark", scene);
    for (std::uint32_t f = 0; f <= 40; ++f) {
      const std::vector<std::uint32_t> changed = changesIn(frames, f);
      writer.write(Frame{f, frames[f], changed});
    }
    EXPECT_EQ(writer.finish(), write(directory / "found.broadmark", scene, frames)) << share;
  }
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
  RecordingWriter full(directory / "a.broadmark", changingSceneOf(frames, true));
  EXPECT_THAT(inputErrorOf([&] { full.write(boxes); }), HasSubstr("all are present"));
}

}  // namespace
}  // namespace broadmark::tests
