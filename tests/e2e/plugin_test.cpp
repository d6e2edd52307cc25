// Algorithms loaded from shared libraries.

#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

class Plugin : public EndToEnd {
 protected:
  Plugin() { fs::copy_file(places::faultyPlugin(), file(plugin_)); }

  /// A small run with more arguments.
  [[nodiscard]] Arguments runWith(const Arguments& more) const {
    Arguments call = {"--headless", "brownian", "--objects", "20", "--frames", "3", "--quiet"};
    call.insert(call.end(), more.begin(), more.end());
    return call;
  }

  std::string plugin_ = "my plug-in.so";
};

TEST_F(Plugin, IsListed) {
  const Ended ended = run({"list", "algorithms", "--plugin", plugin_});
  EXPECT_EQ(ended.status, 0) << ended.err;
  for (const char* word :
       {"faulty-extra", "fat_margin", "1.5", "wrong on purpose", "sap-simd-mt"}) {
    EXPECT_THAT(ended.out, HasSubstr(word));
  }
  EXPECT_THAT(ended.out, HasSubstr("From " + plugin_));
  EXPECT_THAT(run({"list"}).out, Not(HasSubstr("faulty")));
}

TEST_F(Plugin, RunsBesideTheBuiltInOnes) {
  const Ended ended = run(runWith({"--plugin", plugin_, "--algorithm", "Faulty,sap", "--param",
                                   "fat_margin=900", "--json", "results.json"}));
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  const Json cases = readJson(file("results.json")).at("cases");
  ASSERT_EQ(cases.size(), 5U);  // the whole family, and sap
  EXPECT_EQ(cases[0].at("plugin"), "");
  EXPECT_EQ(cases[1].at("algorithm"), "faulty");
  EXPECT_EQ(cases[1].at("plugin"), plugin_);
  const Json& build = cases[1].at("conditions").at("plugin");
  EXPECT_EQ(build.at("hash").get<std::string>().size(), 32U);
  EXPECT_THAT(build.at("flags"), HasSubstr("optimised"));
  EXPECT_EQ(cases[0].at("conditions").at("plugin").at("hash"), "");
  EXPECT_EQ(cases[1].at("pairs"), cases[0].at("pairs"));
  EXPECT_THAT(ended.out, HasSubstr("faulty-extra"));
}

TEST_F(Plugin, AllMeansAlsoThose) {
  const Ended ended = run(runWith({"--plugin", plugin_, "--list"}));
  EXPECT_THAT(ended.out, HasSubstr("/sap\n"));
  EXPECT_THAT(ended.out, HasSubstr("/faulty\n"));
}

TEST_F(Plugin, BadFilesAreRefused) {
  const auto expect_refused = [&](const std::string& path, const std::vector<std::string>& words) {
    expectRefusal({"list", "--plugin", path}, words);
    expectRefusal(runWith({"--plugin", path}), words);
  };
  writeFile(file("text.so"), "no library");
  fs::create_directory(file("folder.so"));
  expect_refused("missing.so", {"missing.so", "No such file"});
  expect_refused("folder.so", {"folder.so", "not a regular file"});
  expect_refused("text.so", {"--plugin", "text.so"});
  expect_refused(places::foreignPlugin(), {"libforeign_plugin.so", "9.9.9"});
  expectRefusal({"list", "--plugin", plugin_, "--plugin", plugin_}, {plugin_, "'faulty'", "taken"});
  expectRefusal(runWith({"--algorithm", "faulty"}), {"--algorithm", "'faulty'"});
  expectRefusal({"--plugin", plugin_, "list"}, {"--plugin", "'list'"});
}

}  // namespace
}  // namespace broadmark::tests
