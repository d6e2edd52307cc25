// Warnings about noisy machines, with simulated machines.

#include "broadmark/harness/noise_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/made_up_system.h"
#include "engine/spoilt_cases.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class NoiseWarnings : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> warnings() const {
    return noiseWarnings(environment_, machine_, test_case_);
  }

  Environment environment_{.governor = "performance", .build_type = "Release"};
  MachineState machine_{.usable_cores = {0, 1, 2, 3}};
  Case test_case_ = caseOf();
};

TEST_F(NoiseWarnings, OfAQuietMachineNothingIsSaid) {
  machine_.busy = {{0, 0.0}, {1, 0.1}, {2, 0.0}, {3, 0.1}};
  machine_.siblings = {{0, {1}}, {1, {0}}};
  test_case_.threads = 4;
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(NoiseWarnings, WhatTheSystemDoesNotTellIsNoWarning) {
  environment_.governor = "";
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(NoiseWarnings, LoadOfOthers) {
  machine_.busy = {{0, 1.0}, {1, 0.0}, {3, 0.3}};
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("1.3 of 4 cores busy")));
}

TEST_F(NoiseWarnings, LoadOfCoresThatWeMayNotUseIsNotOurs) {
  machine_.busy = {{8, 1.0}};
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(NoiseWarnings, ABusyCoreBesideOneThatWeUse) {
  machine_.busy = {{8, 1.0}};
  machine_.siblings = {{1, {8}}, {8, {1}}};
  EXPECT_THAT(warnings(), ElementsAre(AllOf(HasSubstr("core 8"), HasSubstr("sibling of core 1"))));
  test_case_.threads = 4;  // uses all cores
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(NoiseWarnings, FrequenciesThatChange) {
  environment_.governor = "powersave";
  machine_.turbo = true;
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("'powersave'"), HasSubstr("turbo")));
}

TEST_F(NoiseWarnings, MoreThreadsThanCores) {
  test_case_.threads = 5;
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("5 threads share 4 cores")));
}

TEST_F(NoiseWarnings, BuildsWithoutOptimisation) {
  environment_.build_type = "Debug";
  test_case_.algorithm.plugin = "mine.so";
  test_case_.algorithm.plugin_build.unoptimised = true;
  EXPECT_THAT(warnings(),
              ElementsAre(HasSubstr("Debug"), AllOf(HasSubstr("mine.so"), HasSubstr("Release"))));
}

TEST(WatchMachine, ReadsWhatTheSystemTells) {
  const MadeUpSystem system;
  const auto watch = [&] { return sampleMachine(std::chrono::milliseconds(1), system.folders()); };
  EXPECT_EQ(watch().usable_cores, usableCores());
  EXPECT_FALSE(watch().turbo);
  system.write("sys/devices/system/cpu/cpufreq/boost", "1\n");
  EXPECT_TRUE(watch().turbo);
  system.write("sys/devices/system/cpu/intel_pstate/no_turbo", "1\n");
  EXPECT_FALSE(watch().turbo);
  system.write("sys/devices/system/cpu/intel_pstate/no_turbo", "0\n");
  EXPECT_TRUE(watch().turbo);
  system.haveCores(2);
  system.write("sys/devices/system/cpu/cpu0/topology/thread_siblings_list", "0-1\n");
  EXPECT_THAT(watch().siblings.at(0), ElementsAre(1));
}

}  // namespace
}  // namespace broadmark::tests
