// A plug-in that is built again while the inspector shows its algorithm.

#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using Builds = std::vector<std::function<void(const fs::path&)>>;

std::function<void(const fs::path&)> copyOf(const std::string& build) {
  return [build](const fs::path& file) {
    fs::copy_file(build, file, fs::copy_options::overwrite_existing);
  };
}

class RebuiltPlugin : public EndToEnd {
 protected:
  /// Plays a script in the inspector. Each build replaces the plug-in when the script has written
  /// the next file "build 1", "build 2", …
  void play(const Builds& builds, const std::string& script) {
    builds[0](file("mine.so"));
    writeFile(file("script.txt"), "patience 300\nwait idle\nkey End\nwait idle\n" + script);
    Program program(directory_, {"--headless", "--ui", "brownian", "--objects", "400", "--frames",
                                 "6", "--engine", "kinematic", "--plugin", "mine.so", "--algorithm",
                                 "repeated-search", "--script", "script.txt", "--gl", "auto"});
    for (std::size_t number = 1; number < builds.size(); ++number) {
      const fs::path sign = file("build" + std::to_string(number));
      if (!program.waitUntil([&] { return fs::exists(sign); })) break;
      builds[number](file("mine.so"));
    }
    const ProgramResult ended = program.wait();
    EXPECT_EQ(ended.status, 0) << ended.err;
  }
};

TEST_F(RebuiltPlugin, RunsTheSameFramesAndIsFixed) {
  play({copyOf(places::idlePlugin()), [](const fs::path& file) { writeFile(file, "half"); },
        copyOf(places::quickPlugin())},
       "expect status ~ \"is wrong in frame 1\"\n"
       "expect frame = 1\n"
       "write frame build1\n"
       "expect status ~ \"mine.so: cannot be loaded\"\n"
       "write frame build2\n"
       "expect status ~ \"fixed: 0 of 6 frames wrong, 1 of 1 frame before\"\n"
       "expect frame = 6\n"
       "expect algorithm.repeated-search.status = ok\n"
       "expect error = \"\"\n");
}

TEST_F(RebuiltPlugin, IsFasterOrSlower) {
  play({copyOf(places::quickPlugin()), copyOf(places::slowPlugin()), copyOf(places::idlePlugin())},
       "expect frame = 6\n"
       "write frame build1\n"
       "expect status ~ \"repeated-search: 0.0\"\n"
       "expect status ~ \"times as fast on \"\n"
       "write frame build2\n"
       "expect status ~ \"1 of 1 frame wrong, 0 of 6 frames before\"\n"
       "expect frame = 1\n");
}

}  // namespace
}  // namespace broadmark::tests
