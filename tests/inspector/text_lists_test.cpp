// Lists typed as text.
#include "inspector/session/text_lists.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/error.h"

namespace broadmark::tests {
namespace {

TEST(TextLists, UnderstandWhatIsBetweenCommasAndSpaces) {
  EXPECT_THAT(parseWords(" kd, sap*  ,all"), testing::ElementsAre("kd", "sap*", "all"));
  EXPECT_TRUE(parseWords(" , ").empty());
  EXPECT_THAT(parseCounts("1000,8000", "number", 10'000), testing::ElementsAre(1000, 8000));
  EXPECT_THAT(parseCounts(" 1  2, 3,", "number", 10'000), testing::ElementsAre(1, 2, 3));
  EXPECT_TRUE(parseCounts("", "number", 10'000).empty());
}

TEST(TextLists, NameWhatIsNoCount) {
  for (const char* bad : {"0", "-3", "1e3", "many", "10001", "99999999999"}) {
    EXPECT_THROW(parseCounts(bad, "number", 10'000), InputError) << bad;
  }
}

}  // namespace
}  // namespace broadmark::tests
