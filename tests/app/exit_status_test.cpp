// The exit statuses of commands.

#include "support/exit_status.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <set>
#include <vector>

#include "broadmark/files.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

int endOf(const std::vector<Status>& statuses) { return exitStatusOf(statuses); }

TEST(ExitStatus, OfCases) {
  EXPECT_EQ(endOf({}), 0);
  EXPECT_EQ(endOf({Status::ok, Status::unsupported}), 0) << "what cannot run here is no failure";
  EXPECT_EQ(endOf({Status::ok, Status::mismatch}), 1);
  EXPECT_EQ(endOf({Status::error}), 1);
  EXPECT_EQ(endOf({Status::timeout, Status::ok}), 4);
  EXPECT_EQ(endOf({Status::timeout, Status::mismatch}), 1) << "a wrong answer says more";
}

TEST(ExitStatus, AreDocumented) {
  const std::string document = readTextFile(places::source("docs/running.md"));
  std::set<int> values;
  for (const auto& [value, meaning] : kExitStatuses.entries) {
    EXPECT_THAT(document, testing::HasSubstr(fmt::format("\n| {} | ", static_cast<int>(value))));
    EXPECT_TRUE(values.insert(value).second);
  }
}

}  // namespace
}  // namespace broadmark::tests
