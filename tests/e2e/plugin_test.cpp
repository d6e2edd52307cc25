// Algorithms and physics engines loaded from shared libraries.

#include "broadmark/scenes/simulation.h"
#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

class Plugin : public EndToEnd {
 protected:
  Plugin() { fs::copy_file(places::faultyPlugin(), file(plugin_)); }

  /// A small run with these further arguments.
  [[nodiscard]] Arguments runWith(const Arguments& more) const {
    Arguments call = {"--headless", "brownian", "--objects", "20", "--frames", "3", "--quiet"};
    call.insert(call.end(), more.begin(), more.end());
    return call;
  }

  std::string plugin_ = "my plug-in.so";
};

TEST_F(Plugin, IsListed) {
  const ProgramResult ended = run({"list", "algorithms", "--plugin", plugin_});
  EXPECT_EQ(ended.status, 0) << ended.err;
  for (const char* word :
       {"faulty-extra", "fat_margin", "1.5", "wrong on purpose", "sap-simd-mt"}) {
    EXPECT_THAT(ended.out, HasSubstr(word));
  }
  EXPECT_THAT(ended.out, HasSubstr("From " + plugin_));
  EXPECT_THAT(run({"list"}).out, Not(HasSubstr("faulty")));
}

TEST_F(Plugin, RunsBesideTheBuiltInOnes) {
  const ProgramResult ended = run(runWith({"--plugin", plugin_, "--algorithm", "sap,Faulty",
                                           "--param", "fat_margin=900", "--json", "results.json"}));
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  const Json cases = readJson(file("results.json")).at("cases");
  ASSERT_EQ(cases.size(), 8U);  // the whole family, and sap
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
  const ProgramResult ended = run(runWith({"--plugin", plugin_, "--list"}));
  EXPECT_THAT(ended.out, HasSubstr("/sap\n"));
  EXPECT_THAT(ended.out, HasSubstr("/faulty\n"));
}

/// A library with a physics engine.
class EnginePlugin : public EndToEnd {
 protected:
  EnginePlugin() { fs::copy_file(places::enginePlugin(), file(plugin_)); }

  std::string plugin_ = "my engine.so";
};

TEST_F(EnginePlugin, IsListedWithItsParameters) {
  const ProgramResult ended = run({"list", "engines", "--plugin", plugin_});
  EXPECT_EQ(ended.status, 0) << ended.err;
  for (const std::string& word : {std::string("drift: "), std::string("factor on the speed"),
                                  "From " + plugin_, std::string("bullet: ")}) {
    EXPECT_THAT(ended.out, HasSubstr(word));
  }
  EXPECT_THAT(run({"list", "engines"}).out, Not(HasSubstr("drift")));
  EXPECT_THAT(run({"list", "algorithms", "--plugin", plugin_}).out, Not(HasSubstr("drift")));
}

TEST_F(EnginePlugin, MovesTheBodiesOfEveryScene) {
  std::set<std::string> hashes;
  std::size_t recordings = 0;
  for (const std::string drift : {"1", "3"}) {
    const std::string folder = "drift " + drift;
    runQuietly({"bake", "--plugin", plugin_, "--engine", "drift", "--param", "drift=" + drift,
                "--objects", "60", "--frames", "20", "--output", folder});
    for (const auto& entry : fs::recursive_directory_iterator(file(folder))) {
      if (entry.path().extension() != ".json") continue;
      const Json sidecar = readJson(entry.path());
      EXPECT_EQ(sidecar.at("parameters").at("engine"), "drift");
      hashes.insert(sidecar.at("hash"));
      ++recordings;
    }
  }
  EXPECT_EQ(recordings, 2 * builtinScenes().size());
  EXPECT_GT(hashes.size(), recordings * 3 / 4) << "the engine's parameter does nothing";
}

TEST_F(EnginePlugin, RunsLiveAuthoredAndInADuel) {
  const std::string authored = places::source("assets/scenes/dominoes.json").string();
  for (const std::string& source : {std::string("shooter"), authored}) {
    const ProgramResult ended = run({"--headless", source, "--plugin", plugin_, "--engine", "drift",
                                     "--frames", "5", "--algorithm", "sap,kd", "--quiet"});
    EXPECT_EQ(ended.status, 0) << source << ended.out << ended.err;
  }
  const ProgramResult duel =
      run({"duel", "brownian", "sap", "sap-simd", "--plugin", plugin_, "--engine", "drift",
           "--objects", "50", "--frames", "5", "--max-seconds", "0.2"});
  EXPECT_EQ(duel.status, 0) << duel.err;
}

// The program's own plug-ins, which are optional parts of the build.
TEST_F(EnginePlugin, ThoseOfSdksAreLoadedByTheirNames) {
  const std::vector<std::string> lines = linesOf(run({"list", "plugins"}).out);
  ASSERT_GE(lines.size(), 2U);
  for (const std::string& line : lines) {
    if (!line.starts_with("  ") || line.starts_with("   ")) continue;
    const std::string name = line.substr(2, line.find(':') - 2);
    SCOPED_TRACE(name);
    const Arguments call = {"--headless", "brownian",    "--plugin",   name,       "--engine",
                            name,         "--objects",   "50",         "--frames", "5",
                            "--quiet",    "--algorithm", name + "*,kd"};
    if (line.find("not built") == std::string::npos) {
      const ProgramResult ended = run(call);
      EXPECT_EQ(ended.status, 0) << ended.err;
      EXPECT_THAT(ended.out, HasSubstr(name + "-"));
      expectRefusal({"duel", "brownian", name + ":any", "kd"},
                    {"unknown algorithm 'any'", name + "-"});
    } else {
      expectRefusal(call, {"--plugin: " + name + ": not built", "find_package"});
      expectRefusal({"duel", "brownian", name + ":any", "kd"}, {"--plugin: " + name});
    }
  }
}

TEST_F(EnginePlugin, RefusesWhatDoesNotFit) {
  expectRefusal({"--headless", "brownian", "--engine", "drift"}, {"'drift'", "bullet"});
  expectRefusal({"list", "--plugin", plugin_, "--plugin", plugin_}, {plugin_, "'drift'", "taken"});
  expectRefusal({"bake", "--plugin", "no.so", "--output", "x"}, {"no.so", "No such file"});
  expectRefusal(
      {"--headless", "brownian", "--plugin", plugin_, "--engine", "drift", "--param", "drift=-1"},
      {"drift", "-1", "100"});
}

TEST_F(EnginePlugin, AFailureIsAClearError) {
  const Arguments run = {"--headless",
                         "freefall",
                         "--objects",
                         "5",
                         "--frames",
                         "3",
                         "--algorithm",
                         "sap",
                         "--quiet",
                         "--plugin",
                         places::unrulyEngine(),
                         "--engine",
                         "unruly",
                         "--param"};
  const Arguments bake = {"bake",     "--scenes", "freefall", "--objects",
                          "5",        "--frames", "3",        "--output",
                          "out",      "--quiet",  "--plugin", places::unrulyEngine(),
                          "--engine", "unruly",   "--param"};
  for (const auto& [deed, word] :
       std::map<std::string, std::string>{{"throw", "thrown on purpose"},
                                          {"throw-number", "unknown type"},
                                          {"crash", "segmentation fault"},
                                          {"abort", "aborted"}}) {
    for (Arguments call : {run, bake}) {
      call.push_back("engine_deed=" + deed);
      const ProgramResult ended = this->run(call);
      EXPECT_EQ(ended.status, 2) << deed << ended.out;
      EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
      for (const std::string& expected :
           {std::string("engine 'unruly'"), std::string("frame 2"), word}) {
        EXPECT_THAT(ended.err, HasSubstr(expected));
      }
    }
  }
}

TEST_F(EnginePlugin, AHangEndsAtTheLimitOrByOneSignal) {
  Arguments call = {"bake",     "--scenes", "freefall", "--objects",
                    "5",        "--frames", "3",        "--output",
                    "out",      "--quiet",  "--plugin", places::unrulyEngine(),
                    "--engine", "unruly",   "--param",  "engine_deed=hang"};
  Program program(directory_, call);
  ASSERT_TRUE(program.waitForText("hanging on purpose"));
  program.signal(SIGTERM);
  const ProgramResult signalled = program.wait();
  EXPECT_EQ(signalled.status, 130);
  EXPECT_THAT(signalled.err, HasSubstr("engine 'unruly'"));

  call.insert(call.end(), {"--hard-limit", "0.2"});
  const ProgramResult late = run(call);
  EXPECT_EQ(late.status, 2);
  EXPECT_THAT(late.err, HasSubstr("no answer within 0.2 s"));
}

TEST_F(Plugin, InvalidAlgorithmsAreRefused) {
  for (const auto& [fault, words] : std::map<std::string, std::vector<std::string>>{
           {"empty", {"has no algorithms"}},
           {"twice", {"'invalid'", "two parameters 'cells'"}},
           {"range", {"'invalid'", "default", "cells", "11"}},
           {"choice", {"'invalid'", "default", "mode", "'absent'"}},
           {"crash", {"'invalid'", "crashed"}}}) {
    const ProgramEnvironment around{.environment = {{"INVALID_PLUGIN", fault}}};
    expectRefusal({"list", "algorithms", "--plugin", places::invalidPlugin()}, words, around);
  }
  EXPECT_EQ(run({"list", "algorithms", "--plugin", places::invalidPlugin()}).status, 0);
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
