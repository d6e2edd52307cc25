// Help and lists.

#include <algorithm>
#include <sstream>

#include "broadmark/algorithms.h"
#include "broadmark/scenes/simulation.h"
#include "e2e/end_to_end.h"
#include "parts.h"

namespace broadmark::tests {
namespace {

using Help = EndToEnd;
using List = EndToEnd;

void expectWords(const ProgramResult& ended, const std::vector<std::string>& words) {
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "");
  const std::string text = onOneLine(ended.out);
  for (const std::string& word : words) EXPECT_THAT(text, HasSubstr(word));
}

/// The width in characters, not bytes.
std::size_t longestLine(const std::string& text) {
  std::size_t longest = 0;
  for (const std::string& line : linesOf(text)) {
    const auto characters = std::ranges::count_if(line, [](char c) { return (c & 0xC0) != 0x80; });
    longest = std::max(longest, static_cast<std::size_t>(characters));
  }
  return longest;
}

/// The first words of the entries below a heading; without one, the options below all.
std::vector<std::string> entriesOf(const std::string& help, const std::string& heading = {}) {
  std::vector<std::string> entries;
  std::istringstream lines(help.substr(help.find("\n" + heading)));
  std::string line;
  if (!heading.empty()) std::getline(lines >> std::ws, line);
  while (std::getline(lines, line) && (heading.empty() || !line.empty())) {
    if (line.starts_with("  ") && line[2] != ' ' && (!heading.empty() || line[2] == '-')) {
      entries.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
  }
  return entries;
}

TEST_F(Help, OfAllHasThatOfEveryCommand) {
  const ProgramResult help = run({"--help"});
  expectWords(help, {"Usage: broadmark ", "Exit status"});
  std::vector<std::string> all = entriesOf(help.out);
  const std::vector<std::string> commands = entriesOf(help.out, "Commands:");
  EXPECT_FALSE(commands.empty());
  for (const std::string& command : commands) {
    const ProgramResult of_command = run({command, "--help"});
    expectWords(of_command, {"Usage: broadmark " + command});
    for (const std::string& option : entriesOf(of_command.out)) all.push_back(option);
  }
  expectWords(run({"--help-all"}), all);
}

TEST_F(Help, Version) {
  const std::string versions = run({"--version", "--verbose"}).out;
  EXPECT_THAT(versions, HasSubstr("\n  libbullet-dev "));
  EXPECT_THAT(versions, HasSubstr("\n  nlohmann-json3-dev "));
  EXPECT_EQ(versions.find("\n  libode-dev ") != std::string::npos, parts::kOde.included);
  EXPECT_EQ(versions.find("\n  libcgal-dev ") != std::string::npos, parts::kCgal.included);
  EXPECT_EQ(versions.find("\n  libimgui-dev ") != std::string::npos, parts::kInspector.included);
  EXPECT_THAT(linesOf(run({"--version", "--verbose"}).out),
              AllOf(Contains(StartsWith("commit: ")), Contains(StartsWith("compiler: "))));
  expectRefusal({"--verbose"}, {"--verbose", "--version"});
  const ProgramResult ended = run({"--version"});
  expectWords(ended, {"0.", "(commit "});
  EXPECT_EQ(linesOf(ended.out).size(), 1U);
}

TEST_F(List, NamesEverything) {
  const ProgramResult all = run({"list"});
  for (const Algorithm& algorithm : builtinAlgorithms()) {
    expectWords(all, {algorithm.id, algorithm.description.source, algorithm.description.time});
    expectWords(run({"list", "algorithms"}), {algorithm.id});
  }
  for (const SceneListing& scene : builtinScenes()) {
    expectWords(all, {scene.id, scene.summary});
    expectWords(run({"list", "scenes"}), {scene.id, "density", "0.1", "1e-06…1"});
  }
  for (const EngineListing& engine : availableEngines()) {
    expectWords(all, {engine.id, engine.summary});
    expectWords(run({"list", "engines"}), {engine.id});
  }
  expectWords(all, {"Plug-ins", "jolt: "});
  for (const RecorderListing& recorder : builtinRecorders()) {
    expectWords(all, {recorder.id, recorder.summary});
    expectWords(run({"list", "recorders"}), {recorder.id});
  }
}

TEST_F(List, FitsInto100Columns) {
  const ProgramResult all = run({"list"});
  EXPECT_LE(longestLine(all.out), 100U);
  EXPECT_GT(longestLine(all.out), 90U) << "and uses them";
}

TEST_F(List, OfSomeAlgorithms) {
  const ProgramResult ended = run({"list", "algorithms", "kd", "sap*"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  for (const char* word : {"kd: ", "sap-simd: "}) EXPECT_THAT(ended.out, HasSubstr(word));
  EXPECT_THAT(ended.out, Not(HasSubstr("tracy")));
  expectRefusal({"list", "algorithms", "kdd"}, {"list: ", "'kdd'", "'kd'"});
  EXPECT_THAT(run({"list", "algorithms", "kdd"}).err, Not(HasSubstr("--algorithm")));
  expectRefusal({"list", "scenes", "city"}, {"'city'", "algorithms"});
}

TEST_F(List, WhatCannotBePrintedIsAnError) {
  for (const Arguments& call :
       {Arguments{"list"}, Arguments{"--help"}, Arguments{"--version"},
        Arguments{"--headless", "freefall", "--objects", "5", "--frames", "2", "--quiet"}}) {
    const ProgramResult ended = run(call, {.standard_output = "/dev/full"});
    EXPECT_EQ(ended.status, 2) << call.front();
    EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
    EXPECT_THAT(ended.err, StartsWith("broadmark: "));
  }
}

}  // namespace
}  // namespace broadmark::tests
