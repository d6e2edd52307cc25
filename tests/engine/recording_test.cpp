// .aabbs recordings: the bytes, reading, writing, and all kinds of invalid files.

#include "broadmark/recordings/recording.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <climits>
#include <cstring>
#include <limits>
#include <utility>

#include "engine/recording_bytes.h"
#include "torture/inputs.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::StartsWith;

/// A recording of two bodies, one frame and a world from -8 to 8, as bytes.
Bytes handMadeRecording() {
  Bytes bytes(304);
  std::memcpy(bytes.data(), "FreeFall", 8);
  std::memcpy(bytes.data() + 128, "Cubes", 5);
  bytes[256] = 2;                                      // objects
  bytes[260] = 1;                                      // frames
  const Bytes minus_eight = {0x00, 0x00, 0x00, 0xC1};  // -8.0f, little-endian
  const Bytes eight = {0x00, 0x00, 0x00, 0x41};        // 8.0f
  for (const std::size_t offset : {272, 276, 280}) {   // the fourth component stays 0
    std::ranges::copy(minus_eight, bytes.begin() + offset);
    std::ranges::copy(eight, bytes.begin() + offset + 16);
  }
  // Each box: min (low, 0, 0), max (2, 2, 2); `low` differs.
  const Bytes lows[] = {{0, 0, 0, 0},         // 0.0f: initial pose, body 0
                        {0, 0, 0x80, 0x3F},   // 1.0f: body 1
                        {0, 0, 0, 0x3F},      // 0.5f: frame 1, body 0
                        {0, 0, 0xC0, 0x3F}};  // 1.5f: body 1
  const Bytes two = {0, 0, 0, 0x40};
  for (const Bytes& low : lows) {
    bytes.insert(bytes.end(), low.begin(), low.end());
    bytes.insert(bytes.end(), 12, 0);
    for (int i = 0; i < 3; ++i) bytes.insert(bytes.end(), two.begin(), two.end());
    bytes.insert(bytes.end(), 4, 0);
  }
  return bytes;
}

SceneInfo handMadeScene() { return {"FreeFall", "Cubes", 2, 1, {{-8, -8, -8, 0}, {8, 8, 8, 0}}}; }

Aabb handMadeBox(float low) { return {{low, 0, 0, 0}, {2, 2, 2, 0}}; }

RecordingReader recordingOf(const Bytes& bytes) {
  return tests::readerOf<RecordingReader>(bytes, "test.aabbs");
}
std::string recordingFault(const Bytes& bytes) {
  return tests::faultOf<RecordingReader>(bytes, "test.aabbs");
}

TEST(Recording, IsWrittenByteForByte) {
  const TemporaryDirectory directory;
  RecordingWriter writer(directory / "a.aabbs", handMadeScene());
  writer.write(std::vector{handMadeBox(0), handMadeBox(1)});
  writer.write(std::vector{handMadeBox(0.5F), handMadeBox(1.5F)});
  writer.finish();
  EXPECT_EQ(bytesOf(directory / "a.aabbs"), handMadeRecording());
}

TEST(Recording, IsReadByteForByte) {
  RecordingReader reader = recordingOf(handMadeRecording());
  EXPECT_EQ(reader.scene(), handMadeScene());
  const Frame first = reader.rewind();
  EXPECT_EQ(first.index, 0U);
  EXPECT_THAT(first.boxes, ElementsAreArray({handMadeBox(0), handMadeBox(1)}));
  const auto second = reader.next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->index, 1U);
  EXPECT_THAT(second->boxes, ElementsAreArray({handMadeBox(0.5F), handMadeBox(1.5F)}));
  EXPECT_FALSE(reader.next());
}

TEST(Recording, SizeAndFileName) {
  EXPECT_EQ(recordingBytes({.objects = 0, .frames = 0}), 304U);
  EXPECT_EQ(recordingBytes({.objects = 1000, .frames = 1000}), 304U + 32U * 1000 * 1001);
  EXPECT_EQ(recordingBytes({.objects = 1U << 30, .frames = (1U << 29) - 1}), UINT64_MAX)
      << "does not wrap around to 304";
  EXPECT_EQ(recordingFileName({"FreeFall", "Cubes", 1000, 1000, {}}),
            "FreeFall Cubes N1000 F1000frames.aabbs");
  EXPECT_EQ(recordingFileName({"Brownian", "Spheres", 2, 0, {}}, ".posrot"),
            "Brownian Spheres N2 F0frames.posrot");
}

TEST(Recording, WhatIsWrittenIsReadBack) {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory / "a.aabbs";
  const SceneInfo scene = {"Drift", "Assorted", 100, 5, unitBox(3)};
  RecordingWriter writer(path, scene);
  for (std::uint32_t f = 0; f <= 5; ++f) writer.write(inputs::drifting(100, f, 1));
  const std::string hash = writer.finish();

  RecordingReader reader(path);
  EXPECT_EQ(reader.scene(), scene);
  EXPECT_EQ(reader.hash(), hash);
  EXPECT_EQ(hash.size(), 32U);
  EXPECT_EQ(std::filesystem::file_size(path), recordingBytes(scene));
  for (int pass = 0; pass < 2; ++pass) {
    EXPECT_THAT(reader.rewind().boxes, ElementsAreArray(inputs::drifting(100, 0, 1)));
    for (std::uint32_t f = 1; f <= 5; ++f) {
      EXPECT_THAT(reader.next().value().boxes, ElementsAreArray(inputs::drifting(100, f, 1)));
    }
    EXPECT_FALSE(reader.next());
    EXPECT_FALSE(reader.next()) << "the end stays the end";
  }
}

TEST(Recording, ReadingAnywhereGoesOnFromThere) {
  RecordingWriter writer({"Drift", "Boxes", 10, 5, {}});
  for (std::uint32_t f = 0; f <= 5; ++f) writer.write(inputs::drifting(10, f, 1));
  const auto reader = writer.finishTemporary();
  EXPECT_THAT(reader->at(4).boxes, ElementsAreArray(inputs::drifting(10, 4, 1)));
  EXPECT_EQ(reader->next()->index, 5U);
  EXPECT_FALSE(reader->next());
  EXPECT_EQ(reader->at(1).index, 1U);
  reader->hash();
  EXPECT_EQ(reader->next()->index, 2U) << "hashing does not move the position";
  EXPECT_THAT(inputErrorOf([&] { reader->at(6); }),
              AllOf(HasSubstr("no frame 6"), HasSubstr("last one is 5")));
}

TEST(Recording, NoBodiesOrNoFrames) {
  for (const auto& [objects, frames] :
       std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 0}, {0, 7}, {3, 0}}) {
    RecordingWriter writer({"Empty", "Boxes", objects, frames, {}});
    for (std::uint32_t f = 0; f <= frames; ++f) writer.write(chain(objects));
    const auto reader = writer.finishTemporary();
    EXPECT_EQ(reader->rewind().boxes.size(), objects);
    std::uint32_t count = 0;
    while (reader->next()) ++count;
    EXPECT_EQ(count, frames);
    EXPECT_EQ(reader->hash().size(), 32U);
  }
}

TEST(Recording, TheHashTellsFilesApart) {
  Bytes bytes = handMadeRecording();
  const std::string hash = recordingOf(bytes).hash();
  EXPECT_EQ(recordingOf(bytes).hash(), hash);
  putFloat(bytes, bytes.size() - 8, 2.5F);
  EXPECT_NE(recordingOf(bytes).hash(), hash);
}

TEST(RecordingWriter, LeavesNothingUnlessFinished) {
  const TemporaryDirectory directory;
  {
    RecordingWriter writer(directory / "a.aabbs", handMadeScene());
    writer.write(chain(2));
    EXPECT_FALSE(std::filesystem::exists(directory / "a.aabbs"));
  }
  EXPECT_TRUE(directory.empty());
}

TEST(RecordingWriter, AFailedOneKeepsTheOldRecording) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a.aabbs") << "old";
  {
    RecordingWriter writer(directory / "a.aabbs", handMadeScene());
  }
  EXPECT_EQ(std::filesystem::file_size(directory / "a.aabbs"), 3U);
}

TEST(RecordingWriter, NeedsExactlyTheAnnouncedSets) {
  const TemporaryDirectory directory;
  RecordingWriter writer(directory / "a.aabbs", handMadeScene());
  EXPECT_THROW(writer.write(chain(3)), std::logic_error);
  writer.write(chain(2));
  EXPECT_THROW(writer.finish(), std::logic_error);
  writer.write(chain(2));
  writer.write(chain(2));
  EXPECT_THROW(writer.finish(), std::logic_error);
  EXPECT_FALSE(std::filesystem::exists(directory / "a.aabbs"));
}

TEST(RecordingWriter, TwoOfTheSameNameExcludeEachOther) {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory / "a.aabbs";
  RecordingWriter writer(path, handMadeScene());
  EXPECT_THAT(inputErrorOf([&] { RecordingWriter second(path, handMadeScene()); }),
              AllOf(HasSubstr(path.string()), HasSubstr("another process")));
  writer.write(chain(2));
  writer.write(chain(2));
  writer.finish();
  EXPECT_EQ(RecordingReader(path).scene(), handMadeScene()) << "the refused one did no harm";
}

TEST(RecordingWriter, RefusesScenesThatAreNotRecordable) {
  const TemporaryDirectory directory;
  const auto refusal = [&](const SceneInfo& scene) {
    return inputErrorOf([&] { RecordingWriter writer(directory / "a.aabbs", scene); });
  };
  EXPECT_THAT(refusal({.name = std::string(128, 'x')}), HasSubstr("scene name"));
  EXPECT_THAT(refusal({.name = "Frei\xC3\xA4"}), HasSubstr("scene name"));
  EXPECT_THAT(refusal({.name = "a\nb"}), HasSubstr("scene name"));
  EXPECT_THAT(refusal({.object_type = std::string("a\0b", 3)}), HasSubstr("object type"));
  EXPECT_THAT(refusal({.objects = 1U << 31}), HasSubstr("2147483648 bodies"));
  EXPECT_THAT(refusal({.objects = 0, .frames = 2'000'000}), HasSubstr("frames without bodies"));
  EXPECT_TRUE(directory.empty());

  RecordingWriter longest({.name = std::string(127, 'x')});
  longest.write(std::vector<Aabb>());
  EXPECT_EQ(longest.finishTemporary()->scene().name, std::string(127, 'x'));
}

TEST(RecordingWriter, RefusesBoxesThatNoReaderWouldTake) {
  RecordingWriter writer(handMadeScene());
  writer.write(chain(2));
  std::vector<Aabb> boxes = chain(2);
  boxes[1].max[2] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(inputErrorOf([&] { writer.write(boxes); }),
              HasSubstr("frame 1, body 1 (byte 400): the box is infinite"));
  writer.write(chain(2));
  EXPECT_EQ(writer.finishTemporary()->at(1).boxes.size(), 2U) << "the bad set was not written";
}

// Large sets are written while the caller prepares the next set in the same memory.
TEST(RecordingWriter, CopiesLargeSets) {
  constexpr std::uint32_t kBodies = 50'000;
  RecordingWriter writer(SceneInfo{"Drift", "Cubes", kBodies, 3, unitBox(3)});
  std::vector<Aabb> boxes;
  for (std::uint32_t f = 0; f <= 3; ++f) {
    boxes = inputs::drifting(kBodies, f, 1);
    const float good = boxes[kBodies - 1].min[1];
    boxes[kBodies - 1].min[1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(inputErrorOf([&] { writer.write(boxes); }),
                HasSubstr("body 49999 (byte " + std::to_string(304 + 32 * (50'000 * (f + 1) - 1))));
    boxes[kBodies - 1].min[1] = good;
    writer.write(boxes);
    std::ranges::fill(boxes, Aabb{});
  }
  const auto reader = writer.finishTemporary();
  for (std::uint32_t f = 0; f <= 3; ++f) {
    EXPECT_TRUE(std::ranges::equal(reader->at(f).boxes, inputs::drifting(kBodies, f, 1)));
  }
}

TEST(RecordingWriter, SaysWhereItCannotWrite) {
  const TemporaryDirectory directory;
  const auto path = directory / "missing" / "a.aabbs";
  EXPECT_THAT(inputErrorOf([&] { RecordingWriter writer(path, handMadeScene()); }),
              AllOf(HasSubstr(path.string()), HasSubstr("No such file or directory")));
}

TEST(RecordAll, CopiesASourceUnlessStopped) {
  const TemporaryDirectory directory;
  RecordingReader source = recordingOf(handMadeRecording());
  source.at(1);  // recordAll() rewinds the source
  RecordingWriter copy(directory / "copy.aabbs", source.scene());
  std::vector<std::uint32_t> reported;
  EXPECT_TRUE(recordAll(source, copy, [&](std::uint32_t frame) {
    reported.push_back(frame);
    return true;
  }));
  EXPECT_EQ(copy.finish(), source.hash());
  EXPECT_EQ(reported, (std::vector<std::uint32_t>{0, 1}));

  RecordingWriter stopped(directory / "stopped.aabbs", source.scene());
  EXPECT_FALSE(recordAll(source, stopped, [](std::uint32_t) { return false; }));
  EXPECT_THROW(stopped.finish(), std::logic_error);
}

TEST(BadRecording, TooShortOrTooLong) {
  const Bytes whole = handMadeRecording();
  for (const std::size_t size : {0, 1, 128, 303}) {
    EXPECT_THAT(recordingFault(Bytes(whole.begin(), whole.begin() + size)),
                AllOf(StartsWith("test.aabbs: "), HasSubstr("too short")));
  }
  for (const std::size_t size : {304, 336, 431}) {
    EXPECT_THAT(recordingFault(Bytes(whole.begin(), whole.begin() + size)),
                AllOf(HasSubstr(std::to_string(size) + " bytes is too short"),
                      HasSubstr("2 bodies and 1 frames"), HasSubstr("= 432 bytes")));
  }
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_THAT(recordingFault(longer), HasSubstr("433 bytes is too long"));
}

TEST(BadRecording, NegativeAndAbsurdCounts) {
  struct Counts {
    std::int32_t objects, frames;
    const char* fault;
  };
  const Counts invalid[] = {{-1, 1, "byte 256: negative number of bodies (-1)"},
                            {INT_MIN, 1, "byte 256: negative"},
                            {2, -1, "byte 260: negative number of frames (-1)"},
                            {INT_MAX, INT_MAX, "too short"},
                            {INT_MAX, 0, "too short"},
                            {2, INT_MAX, "too short"},
                            {0, INT_MAX, "byte 260: 2147483647 frames without bodies"},
                            {2, 0, "too long"},
                            {1, 1, "too long"}};
  for (const Counts& counts : invalid) {
    Bytes bytes = handMadeRecording();
    putInt(bytes, 256, counts.objects);
    putInt(bytes, 260, counts.frames);
    EXPECT_THAT(recordingFault(bytes), HasSubstr(counts.fault));
  }
}

// 2^30 objects in 2^29 sets need 2^64 bytes, which is 0 in 64 bits: the size would seem right, and
// a frame would need 32 GiB.
TEST(BadRecording, CountsThatWrapAround) {
  Bytes bytes = handMadeRecording();
  bytes.resize(304);
  putInt(bytes, 256, 1 << 30);
  putInt(bytes, 260, (1 << 29) - 1);
  EXPECT_THAT(recordingFault(bytes), HasSubstr("too short"));
}

TEST(BadRecording, BrokenBoxesAreNamedWithTheirPlace) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  // Frame 1, body 1 is at 304 + 32 · (2 + 1) = 400.
  struct Fault {
    std::size_t offset;
    float value;
    const char* text;
  };
  const Fault faults[] = {{400, kNan, "frame 1, body 1 (byte 400): the box is not a number"},
                          {416, kNan, "frame 1, body 1 (byte 400): the box is not a number"},
                          {424, kInfinity, "frame 1, body 1 (byte 400): the box is infinite"},
                          {404, -kInfinity, "frame 1, body 1 (byte 400): the box is infinite"},
                          {408, 2.5F, "frame 1, body 1 (byte 400): the box is inverted"},
                          {304, kNan, "frame 0, body 0 (byte 304): the box is not a number"},
                          {340, 3, "frame 0, body 1 (byte 336): the box is inverted"},
                          {272, kNan, "byte 272: the world box is not a number"},
                          {276, 9, "byte 272: the world box is inverted"}};
  for (const Fault& fault : faults) {
    Bytes bytes = handMadeRecording();
    putFloat(bytes, fault.offset, fault.value);
    EXPECT_THAT(recordingFault(bytes), AllOf(StartsWith("test.aabbs: "), HasSubstr(fault.text)));
  }
}

TEST(BadRecording, UnprintableNames) {
  for (const unsigned char c : Bytes{0x01, 0x0A, 0x7F, 0xC3, 0xFF}) {
    Bytes bytes = handMadeRecording();
    bytes[3] = c;
    EXPECT_THAT(recordingFault(bytes), HasSubstr("byte 0: the scene name is not printable"));
  }
  Bytes endless = handMadeRecording();
  std::fill_n(endless.begin() + 128, 128, 'x');
  EXPECT_THAT(recordingFault(endless), HasSubstr("byte 128: the object type is not printable"));
}

TEST(BadRecording, CutWhileItIsRead) {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory / "a.aabbs";
  const Bytes bytes = handMadeRecording();
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  RecordingReader reader(path);
  reader.rewind();
  std::filesystem::resize_file(path, 400);
  EXPECT_THAT(inputErrorOf([&] { reader.next(); }), HasSubstr("ends at byte 400"));
  EXPECT_THAT(inputErrorOf([&] { reader.hash(); }), HasSubstr("ends at byte"));
}

TEST(BadRecording, WhatIsNoFile) {
  const TemporaryDirectory directory;
  const std::filesystem::path fifo = directory / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  const std::filesystem::path file = directory / "empty";
  {
    const std::ofstream empty(file);
  }
  const std::pair<std::filesystem::path, const char*> invalid[] = {
      {directory / "missing", "No such file"},
      {directory / "", "not a regular file"},
      {fifo, "not a regular file"},
      {"/dev/zero", "not a regular file"},
      {file / "within", "Not a directory"},
      {file, "0 bytes is too short"}};
  for (const auto& [path, fault] : invalid) {
    EXPECT_THAT(inputErrorOf([&] { RecordingReader reader(path); }),
                AllOf(StartsWith(path.string()), HasSubstr(fault)));
  }
}

}  // namespace
}  // namespace broadmark::tests
