// Names that users enter.

#include "broadmark/names.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <climits>

#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::vector<std::string> kKnown = {"bf", "sap", "sap-simd", "grid-sap", "FreeFall", "tracy"};

TEST(NearestName, FindsTyposWhateverTheCase) {
  EXPECT_EQ(nearestName("sap-simd", kKnown), "sap-simd");
  EXPECT_EQ(nearestName("sap_sim", kKnown), "sap-simd");
  EXPECT_EQ(nearestName("freefal", kKnown), "FreeFall");
  EXPECT_EQ(nearestName("TRACY", kKnown), "tracy");
  EXPECT_EQ(nearestName("grisap", kKnown), "grid-sap");
}

TEST(NearestName, IsEmptyWhenNothingIsNear) {
  EXPECT_EQ(nearestName("brownian-motion", kKnown), "");
  EXPECT_EQ(nearestName("sap", {}), "");
  EXPECT_EQ(nearestName(std::string(100'000, 's'), kKnown), "");
}

TEST(UnknownName, SaysWhatWasMeantAndWhatThereIs) {
  EXPECT_EQ(unknownName("algorithm", "sapp", kKnown),
            "unknown algorithm 'sapp'; did you mean 'sap'? (one of: bf, sap, sap-simd, grid-sap, "
            "FreeFall, tracy)");
  EXPECT_THAT(unknownName("algorithm", "quadtree-loose", kKnown),
              AllOf(HasSubstr("'quadtree-loose' (one of"), Not(HasSubstr("did you mean"))));
}

TEST(Glob, MatchesWholeWords) {
  EXPECT_TRUE(globMatches("sap*", "sap-simd-mt"));
  EXPECT_TRUE(globMatches("*-mt", "sap-simd-mt"));
  EXPECT_TRUE(globMatches("grid?d-*", "grid2d-bf"));
  EXPECT_TRUE(globMatches("*", ""));
  EXPECT_FALSE(globMatches("sap", "sap-simd"));
  EXPECT_FALSE(globMatches("sap*", "grid-sap"));
  EXPECT_FALSE(globMatches("?", ""));
}

TEST(ParseInteger, TakesWholeTextsWithinRange) {
  EXPECT_EQ(parseInteger("42", "--objects", 0, 100), 42);
  EXPECT_EQ(parseInteger("0", "--objects", 0, 100), 0);
  EXPECT_EQ(parseInteger("-100", "--shift", -100, 100), -100);
  EXPECT_EQ(parseInteger("9223372036854775807", "--seed", 0, LLONG_MAX), LLONG_MAX);
}

TEST(ParseInteger, RefusesEverythingElse) {
  for (const char* text : {"", " 1", "1 ", "+1", "1.0", "1e2", "0x10", "ten", "101", "-1",
                           "9223372036854775808", "99999999999999999999999"}) {
    EXPECT_THAT(
        inputErrorOf([&] { parseInteger(text, "--objects", 0, 100); }),
        AllOf(HasSubstr("--objects"), HasSubstr(fmt::format("'{}'", text)), HasSubstr("0 to 100")));
  }
}

}  // namespace
}  // namespace broadmark::tests
