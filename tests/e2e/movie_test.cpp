// bake --movie: recordings as numbered pictures.

#include <fmt/format.h>

#include "broadmark/render/picture.h"
#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

class Movie : public EndToEnd {
 protected:
  [[nodiscard]] static Arguments call(const Arguments& more = {}) {
    Arguments all = {"bake", "--scenes", "freefall", "--objects", "30",   "--frames",
                     "9",    "--output", "out",      "--movie",   "film", "--movie-every",
                     "3",    "--size",   "160x90"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  [[nodiscard]] std::set<std::string> pictures() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(file(kFolder))) {
      if (entry.path().extension() == ".png") names.insert(entry.path().filename());
    }
    return names;
  }

  static constexpr const char* kFolder = "film/FreeFall Cubes N30 F9frames";
  const std::set<std::string> kAll = {"frame_00000.png", "frame_00001.png", "frame_00002.png",
                                      "frame_00003.png"};
};

TEST_F(Movie, IsDrawnFrameByFrame) {
  const ProgramResult ended = runQuietly(call());
  EXPECT_THAT(ended.out, HasSubstr(fmt::format("movie  {}\n", kFolder)));
  EXPECT_EQ(pictures(), kAll);
  std::set<std::string> different;
  for (const std::string& name : pictures()) {
    const Picture picture = readPng(file(kFolder) / name);
    EXPECT_EQ(picture.width, 160);
    EXPECT_EQ(picture.height, 90);
    different.insert(readFile(file(kFolder) / name));
  }
  EXPECT_EQ(different.size(), kAll.size());
}

TEST_F(Movie, ShowsWhatAScreenshotShows) {
  runQuietly(call());
  runQuietly({"--headless", recordingIn("out", "FreeFall Cubes N30 F9frames"), "--algorithm", "sap",
              "--screenshot", "shot.png", "--frame", "6", "--size", "160x90"});
  EXPECT_EQ(readPng(file("shot.png")).rgba, readPng(file(kFolder) / "frame_00002.png").rgba);
}

TEST_F(Movie, IsKeptUntilItWouldBeAnother) {
  runQuietly(
      {"bake", "--scenes", "freefall", "--objects", "30", "--frames", "9", "--output", "out"});
  EXPECT_THAT(runQuietly(call()).out, StartsWith("kept   ")) << "of a recording that was there";
  const fs::path last = file(kFolder) / "frame_00003.png";
  const auto long_ago = fs::last_write_time(last) - std::chrono::hours(1);
  fs::last_write_time(last, long_ago);
  runQuietly(call());
  EXPECT_EQ(fs::last_write_time(last), long_ago);

  // An interrupted movie lacks a picture.
  fs::remove(file(kFolder) / "frame_00002.png");
  runQuietly(call());
  EXPECT_EQ(pictures(), kAll);
  EXPECT_NE(fs::last_write_time(last), long_ago);

  // Another recording of the same name with fewer frames: no old pictures remain.
  const std::string before = readFile(last);
  runQuietly(call({"--seed", "2", "--force"}));
  EXPECT_NE(readFile(last), before);
  Arguments shorter = call({"--seed", "2"});
  *std::ranges::find(shorter, "3") = "5";
  runQuietly(shorter);
  EXPECT_EQ(pictures(), (std::set<std::string>{"frame_00000.png", "frame_00001.png"}));
}

TEST_F(Movie, BadOptions) {
  expectRefusal(call({"--gl", "egll"}), {"--gl", "'egll'", "'egl'"});
  expectRefusal({"bake", "--output", "no", "--movie-every", "2"}, {"--movie-every", "--movie"});
}

}  // namespace
}  // namespace broadmark::tests
