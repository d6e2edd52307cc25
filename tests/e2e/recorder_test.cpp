// integrations/broadmark_recorder.h: what it records is read and audited by the program.

#include "integrations/broadmark_recorder.h"

#include <array>
#include <limits>

#include "broadmark/hasher.h"
#include "e2e/end_to_end.h"
#include "support/recorded_session.h"

namespace broadmark::tests {
namespace {

class Recorder : public EndToEnd {
 protected:
  ~Recorder() override { broadmark_record_end(&recorder_); }

  bool begin(std::uint32_t max_bodies = 0) {
    if (broadmark_record_begin(&recorder_, file("session").c_str(), max_bodies) == 0) return false;
    layer_ = broadmark_record_layer(&recorder_, 1, 1);
    return true;
  }
  /// A unit box from `x` on.
  bool add(std::uint64_t body, double x) { return addBox(body, x, x + 1); }
  bool addBox(std::uint64_t body, double min_x, double max_x) {
    const std::array<double, 3> min = {min_x, 0, 0};
    const std::array<double, 3> max = {max_x, 1, 1};
    return broadmark_record_box(&recorder_, body, min.data(), max.data(), layer_,
                                BROADMARK_NO_TAG) != 0;
  }
  bool pair(std::uint64_t a, std::uint64_t b) {
    return broadmark_record_pair(&recorder_, a, b) != 0;
  }
  bool endFrame() { return broadmark_record_frame(&recorder_) != 0; }
  ProgramResult audit() const {
    return run({"audit", "session.broadmark", "session.csv", "--quiet"});
  }
  [[nodiscard]] std::string error() const { return recorder_.error; }

  broadmark_recorder recorder_{};
  unsigned layer_ = 0;
};

TEST_F(Recorder, SessionsInCAreAudited) {
  ASSERT_TRUE(recordSession(file("session").c_str()));
  EXPECT_THAT(run({"verify", "session.broadmark"}).out, HasSubstr("session Bodies, 30 bodies, 11"));
  ProgramResult ended = audit();
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("pairs in 12 frames, of which none is wrong"));

  const std::string log = readFile(file("session.csv"));
  const std::size_t last = log.rfind('\n', log.size() - 2) + 1;
  writeFile(file("session.csv"), log.substr(0, last));
  ended = audit();
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.out, testing::ContainsRegex("missed +1 +1 +11 "));
}

TEST_F(Recorder, FilesAreCompleteAfterEachFrame) {
  ASSERT_TRUE(begin());
  for (const double shift : {0.0, 0.25, 0.5}) {
    ASSERT_TRUE(pair(1, 2) && add(1, shift) && add(2, 0.5) && endFrame()) << error();
    EXPECT_EQ(audit().status, 0) << audit().out << audit().err;
  }
  ASSERT_TRUE(pair(1, 2) && add(1, 0));  // the beginning of a frame is not written
  ASSERT_TRUE(broadmark_record_end(&recorder_));
  EXPECT_THAT(audit().out, HasSubstr("3 pairs in 3 frames, of which none is wrong"));

  const std::string bytes = readFile(file("session.broadmark"));
  writeFile(file("cut.broadmark"), bytes.substr(0, bytes.size() - 40));
  expectRefusal({"verify", "cut.broadmark"}, {"cut short"});
}

TEST_F(Recorder, GoneBodiesLeaveTheirPlaceToOthers) {
  ASSERT_TRUE(begin(4));
  for (std::uint64_t frame = 0; frame < 40; ++frame) {
    ASSERT_TRUE(add(7 * frame, 0) && (frame % 3 == 0 || add(7 * frame + 7, 0.5)) &&
                (frame % 3 == 0 || pair(7 * frame, 7 * frame + 7)) && endFrame())
        << error();
  }
  EXPECT_EQ(audit().status, 0) << audit().out << audit().err;
  EXPECT_FALSE(add(1, 0) && add(2, 0) && add(3, 0) && add(4, 0));
  EXPECT_THAT(error(), HasSubstr("frame 40: there are more bodies than max_bodies"));
  EXPECT_FALSE(endFrame());
}

TEST_F(Recorder, PairsOfUnknownBodiesAreImpossible) {
  ASSERT_TRUE(begin());
  for (int frame = 0; frame < 2; ++frame) {
    ASSERT_TRUE(add(1, 0) && pair(1, 2) && endFrame());
  }
  EXPECT_THAT(audit().out, testing::ContainsRegex("impossible +2"));
}

TEST_F(Recorder, RoundingOfDoublesMakesNoPairMissed) {
  ASSERT_TRUE(begin());
  for (int frame = 0; frame < 2; ++frame) {
    // As floats to the nearest, these boxes touch.
    ASSERT_TRUE(addBox(1, 0, 0.1) && addBox(2, 0.1 + 1e-12, 1) && endFrame());
  }
  EXPECT_EQ(audit().status, 0) << audit().out;
}

TEST_F(Recorder, MistakesEndTheRecording) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect_error = [&](const char* words, auto&& mistake) {
    ASSERT_TRUE(begin(4)) << error();
    ASSERT_TRUE(add(1, 0) && endFrame());
    mistake();
    EXPECT_FALSE(endFrame());
    EXPECT_THAT(error(), HasSubstr(words));
    EXPECT_EQ(broadmark_record_end(&recorder_), 0);
    EXPECT_EQ(run({"verify", "session.broadmark"}).status, 0) << "the frame before remains";
    fs::remove(file("session.broadmark"));
    fs::remove(file("session.csv"));
  };
  expect_error("frame 1: a box is not a number", [&] { addBox(1, 0, nan); });
  expect_error("its min is over its max", [&] { addBox(1, 1, 0); });
  expect_error("twice", [&] { add(1, 0) && add(1, 0); });
  expect_error("layer", [&] { layer_ = 1, add(1, 0); });
  expect_error("more than 32", [&] {
    for (std::uint64_t i = 0; i < 32; ++i) broadmark_record_layer(&recorder_, i, 5);
  });

  writeFile(file("session.csv"), "mine");
  EXPECT_FALSE(begin());
  EXPECT_THAT(error(), HasSubstr("exists"));
  EXPECT_EQ(readFile(file("session.csv")), "mine");
  EXPECT_EQ(broadmark_record_begin(&recorder_, file("no/folder").c_str(), 0), 0);
  EXPECT_THAT(error(), HasSubstr("folder"));
}

TEST_F(Recorder, ChecksumsAreThoseOfTheProgram) {
  std::vector<unsigned char> bytes;
  for (unsigned i = 0; i < 4000; ++i) bytes.push_back(static_cast<unsigned char>(i * i / 7));
  for (std::size_t size = 0; size <= bytes.size(); size += size < 256 ? 32 : 1) {
    std::array<std::uint64_t, 2> hash{};
    bmr_hash(bytes.data(), size, hash.data());
    const HashValue expected = hashOf(std::as_bytes(std::span(bytes).first(size)));
    ASSERT_EQ(hash, (std::array{expected.low, expected.high})) << size;
  }
}

}  // namespace
}  // namespace broadmark::tests
