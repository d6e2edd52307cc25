// The description of the machine.

#include "broadmark/harness/environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "broadmark/execution.h"

namespace broadmark::tests {
namespace {

using testing::AnyOf;
using testing::MatchesRegex;
using testing::StartsWith;

TEST(Environment, IsPlausible) {
  const Environment environment = thisEnvironment();
  EXPECT_NE(environment.host, "");
  EXPECT_NE(environment.cpu, "");
  EXPECT_GE(environment.logical_cores, 1);
  EXPECT_LE(environment.logical_cores, 4096);
  EXPECT_GE(environment.physical_cores, 0);  // 0: unknown
  EXPECT_EQ(environment.isa, isaName(bestIsa()));
  EXPECT_GE(environment.memory_bytes, std::uint64_t{1} << 28);
  EXPECT_LE(environment.memory_bytes, std::uint64_t{1} << 50);
  EXPECT_GE(environment.load_average, 0);
  for (const std::string& cache : environment.caches) EXPECT_THAT(cache, StartsWith("L"));
  EXPECT_THAT(environment.os, testing::HasSubstr("Linux"));
  EXPECT_THAT(environment.compiler, AnyOf(StartsWith("gcc "), StartsWith("clang ")));
  EXPECT_NE(environment.build_type, "");
  EXPECT_THAT(environment.version, MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_THAT(environment.commit, MatchesRegex("([0-9a-f]{40})?"));  // "": no repository
  EXPECT_EQ(environment.commit_date.empty(), environment.commit.empty());
  EXPECT_THAT(environment.started,
              MatchesRegex("[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z"));
}

TEST(Environment, BuildsAreNamed) {
  Environment environment{.compiler = "gcc 12", .compiler_flags = " -O3", .version = "1.2.3"};
  EXPECT_EQ(commitName(environment), "unknown");
  environment.commit = std::string(10, 'a') + std::string(30, 'b');
  EXPECT_EQ(commitName(environment), "aaaaaaaaaa");
  environment.dirty = true;
  EXPECT_EQ(buildName(environment), "1.2.3 (commit aaaaaaaaaa with changes, gcc 12 -O3)");
}

}  // namespace
}  // namespace broadmark::tests
