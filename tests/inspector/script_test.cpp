#include "inspector/script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/files.h"
#include "engine/helpers.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

TEST(Script, LinesAreVerbsAndWords) {
  const auto lines =
      parseScript("# a demonstration\n\nclick \"Playback/Play\"  # now\nwait 3\n", "s");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].number, 3);
  EXPECT_STREQ(lines[0].verb->name, "click");
  EXPECT_EQ(lines[0].words, std::vector<std::string>{"Playback/Play"});
  EXPECT_EQ(lines[1].words, std::vector<std::string>{"3"});
}

TEST(Script, WrongLinesAreNamed) {
  EXPECT_THAT(inputErrorOf([] { parseScript("click a\nclik b", "my.txt"); }),
              testing::AllOf(testing::HasSubstr("my.txt: line 2"), testing::HasSubstr("click")));
  EXPECT_THAT(inputErrorOf([] { parseScript("enter Scene/objects", "s"); }),
              testing::HasSubstr("enter WIDGET TEXT"));
  EXPECT_THAT(inputErrorOf([] { parseScript("wait", "s"); }), testing::HasSubstr("wait"));
}

TEST(Script, EveryVerbIsDocumented) {
  const std::string text = readTextFile(places::source("docs/inspector.md"));
  for (const ScriptVerb& verb : scriptVerbs()) {
    EXPECT_THAT(text, testing::HasSubstr(fmt::format("\n| `{} {}` | ", verb.name, verb.arguments)));
  }
}

}  // namespace
}  // namespace broadmark::tests
