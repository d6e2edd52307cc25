// --screenshot: one picture of each recording.

#include "broadmark/render/picture.h"
#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

using Screenshot = EndToEnd;

TEST_F(Screenshot, EachSceneHasItsOwnInTheMainJob) {
  runQuietly({"--headless", "freefall", "brownian", "--objects", "80", "--frames", "6",
              "--algorithm", "sap", "--screenshot", "picture.png", "--size", "160x90", "--json",
              "results.json", "--record", "recordings"});
  for (const std::string scene : {"FreeFall", "Brownian"}) {
    const Picture picture = readPng(file("picture " + scene + " Cubes N80.png"));
    EXPECT_EQ(picture.width, 160);
    EXPECT_EQ(picture.height, 90);
  }
}

TEST_F(Screenshot, FewBodies) {
  runQuietly({"--headless", "freefall", "--objects", "2,0,1", "--frames", "3", "--algorithm", "sap",
              "--screenshot", "few.png", "--size", "40x30"});
  for (const char* count : {"0", "1", "2"}) {
    EXPECT_EQ(readPng(file(std::string("few FreeFall Cubes N") + count + ".png")).width, 40);
  }
}

TEST_F(Screenshot, RecordingsAlikeInNameGetPicturesOfTheirOwn) {
  bakeRecording("one.aabbs", "20", "2", "1");
  bakeRecording("two.aabbs", "20", "2", "2");
  runQuietly({"--headless", "one.aabbs", "two.aabbs", "--algorithm", "sap", "--screenshot", "p.png",
              "--size", "80x60"});
  EXPECT_NE(readPng(file("p FreeFall Cubes N20.png")).rgba,
            readPng(file("p FreeFall Cubes N20 (2).png")).rgba);
}

TEST_F(Screenshot, AnyFrameCanBeDrawnTheInitialPoseToo) {
  std::set<std::string> pictures;
  for (const std::string frame : {"0", "1", "5"}) {
    runQuietly({"--headless", "brownian", "--objects", "20", "--frames", "5", "--algorithm", "sap",
                "--screenshot", frame + ".png", "--frame", frame, "--size", "80x60"});
    pictures.insert(readFile(file(frame + ".png")));
  }
  EXPECT_EQ(pictures.size(), 3U);
  runQuietly({"--headless", "brownian", "--objects", "20", "--frames", "5", "--algorithm", "sap",
              "--screenshot", "last.png", "--size", "80x60"});
  EXPECT_EQ(readPng(file("last.png")).rgba, readPng(file("5.png")).rgba);
}

TEST_F(Screenshot, EitherGlSourceDraws) {
  for (const std::string source : {"egl", "osmesa"}) {
    runQuietly({"--headless", "freefall", "--objects", "20", "--frames", "2", "--algorithm", "sap",
                "--screenshot", source + ".png", "--gl", source, "--size", "64x48"});
    const Picture picture = readPng(file(source + ".png"));
    EXPECT_EQ(picture.width, 64);
    EXPECT_EQ(picture.height, 48);
  }
}

TEST_F(Screenshot, WithoutGlThereIsNoPictureButEverythingElse) {
  // Broken libraries of the same names precede the real ones in the search path.
  fs::create_directory(file("hidden"));
  for (const char* library : {"libEGL.so.1", "libOSMesa.so.8"}) {
    writeFile(file("hidden") / library, "");
  }
  for (const std::string source : {"auto", "egl", "osmesa"}) {
    const std::string json = source + ".json";
    const ProgramResult ended =
        run({"--headless", "freefall", "--objects", "20", "--frames", "2", "--algorithm", "sap",
             "--screenshot", "p.png", "--gl", source, "--json", json, "--quiet"},
            {.environment = {{"LD_LIBRARY_PATH", file("hidden").string()}}});
    EXPECT_EQ(ended.status, 2);
    EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
    EXPECT_THAT(ended.err, StartsWith("broadmark: no screenshot: "));
    EXPECT_THAT(ended.err, HasSubstr(source == "osmesa" ? "libOSMesa" : "libEGL"));
    EXPECT_THAT(ended.out, HasSubstr("sap"));
    EXPECT_THAT(ended.out, Not(HasSubstr("p.png")));
    EXPECT_EQ(readJson(file(json)).at("cases").size(), 1U);
    EXPECT_FALSE(fs::exists(file("p.png")));
  }
}

}  // namespace
}  // namespace broadmark::tests
