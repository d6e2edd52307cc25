// Processor cores: their state in simulated systems, and the choice of cores.

#include "broadmark/cores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <thread>

#include "broadmark/execution.h"
#include "broadmark/harness/case_executor.h"
#include "engine/made_up_system.h"
#include "engine/spoilt_cases.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

TEST(Cores, BusySharesComeFromTheTicksBetweenTwoReadings) {
  MadeUpSystem system;
  system.write("proc/stat",
               "cpu  9 9 9 9 9 9 9 9 9 9\n"
               "cpu0 100 0 0 100 0 0 0 0 0 0\n"
               "cpu1 0 0 0 500 0 0 0 0 0 0\n"
               "intr 5 0 0\n");
  const auto before = coreTicks(system.folders());
  system.write("proc/stat",
               "cpu0 103 1 1 104 1 0 0 0 99 99\n"
               "cpu1 0 0 0 500 0 5 3 2 0 0\n"
               "cpu2 1 1 1 1\n");
  const BusyShares busy = busySharesBetween(before, coreTicks(system.folders()));
  EXPECT_THAT(busy, ElementsAre(testing::Pair(0, 0.5), testing::Pair(1, 1.0)));
}

TEST(Cores, ASystemThatTellsNothingHasNoShares) {
  const MadeUpSystem system;
  EXPECT_THAT(measureBusyShares(std::chrono::hours(1), system.folders()), IsEmpty());
  EXPECT_THAT(coreSiblings(system.folders()), IsEmpty());
}

TEST(Cores, SiblingsAreListsAndRanges) {
  MadeUpSystem system;
  system.haveCores(5);
  system.write("sys/devices/system/cpu/cpu0/topology/thread_siblings_list", "0-1\n");
  system.write("sys/devices/system/cpu/cpu1/topology/thread_siblings_list", "0-1\n");
  system.write("sys/devices/system/cpu/cpu2/topology/thread_siblings_list", "2,4\n");
  system.write("sys/devices/system/cpu/cpu3/topology/thread_siblings_list", "3\n");
  EXPECT_THAT(coreSiblings(system.folders()),
              ElementsAre(testing::Pair(0, ElementsAre(1)), testing::Pair(1, ElementsAre(0)),
                          testing::Pair(2, ElementsAre(4))));
}

TEST(Cores, ThoseBeyondTheQuotaAreNotAvailable) {
  const int usable = static_cast<int>(usableCores().size());
  MadeUpSystem system;
  EXPECT_EQ(availableCores(system.folders()), usable);
  system.write("proc/self/cgroup", "0::/jobs/one\n");
  system.write("sys/fs/cgroup/jobs/one/cpu.max", "max 100000\n");
  EXPECT_EQ(availableCores(system.folders()), usable);
  system.write("sys/fs/cgroup/jobs/cpu.max", "150000 100000\n");
  EXPECT_EQ(availableCores(system.folders()), std::min(usable, 2));
  system.write("sys/fs/cgroup/jobs/one/cpu.max", "10000 100000\n");
  EXPECT_EQ(availableCores(system.folders()), 1);
}

TEST(Cores, AQuotaOfALargeMachineIsRoundedUp) {
  MadeUpSystem system;
  system.write("proc/self/cgroup", "0::/job\n");
  EXPECT_EQ(availableCores(system.folders(), 64), 64);
  system.write("sys/fs/cgroup/job/cpu.max", "6400000 100000\n");
  EXPECT_EQ(availableCores(system.folders(), 64), 64);
  EXPECT_EQ(availableCores(system.folders(), 48), 48);  // by the affinity mask
  system.write("sys/fs/cgroup/job/cpu.max", "3250000 100000\n");
  EXPECT_EQ(availableCores(system.folders(), 64), 33);
  system.write("sys/fs/cgroup/cpu.max", "1600000 100000\n");  // of a container
  EXPECT_EQ(availableCores(system.folders(), 64), 16);
}

TEST(Cores, TheQuietestAreChosen) {
  const std::vector<int> usable = {0, 1, 2, 3};
  EXPECT_THAT(quietestCores(2, usable, {}, {}), ElementsAre(0, 1));
  EXPECT_THAT(quietestCores(2, usable, {{0, 1.0}, {1, 0.1}, {2, 0}, {3, 0.2}}, {}),
              ElementsAre(2, 1));
  EXPECT_THAT(quietestCores(4, usable, {{0, 1.0}}, {}), UnorderedElementsAre(0, 1, 2, 3));
  EXPECT_THAT(quietestCores(5, usable, {}, {}), IsEmpty());
}

TEST(Cores, HalvesOfOneAreChosenLast) {
  const std::vector<int> usable = {0, 1, 2, 3};
  const CoreSiblings halves = {{0, {1}}, {1, {0}}, {2, {3}}, {3, {2}}};
  EXPECT_THAT(quietestCores(2, usable, {}, halves), ElementsAre(0, 2));
  EXPECT_THAT(quietestCores(3, usable, {}, halves), ElementsAre(0, 2, 1));
  // A busy core slows its sibling.
  EXPECT_THAT(quietestCores(1, usable, {{0, 1.0}}, halves), ElementsAre(2));
}

/// The usable cores of each worker in a team.
std::vector<std::vector<int>> usableByWorker(ThreadTeam& team) {
  std::vector<std::vector<int>> usable(static_cast<std::size_t>(team.size()));
  team.run([&](int worker) { usable[static_cast<std::size_t>(worker)] = usableCores(); });
  return usable;
}

/// Runs `test` on a separate thread, as pinning is permanent.
template <class Test>
void onAnotherThread(Test&& test) {
  std::thread(test).join();
}

TEST(Pinning, EachWorkerHasItsOwnCore) {
  onAnotherThread([] {
    const std::vector<int> usable = usableCores();
    ThreadTeam team(static_cast<int>(std::min<std::size_t>(usable.size(), 4)));
    const std::vector<int> cores = quietestCores(team.size(), usable, {}, {});
    if (!team.pin(cores, usable)) GTEST_SKIP() << "this system allows no pinning";
    const auto by_worker = usableByWorker(team);
    for (std::size_t i = 0; i < cores.size(); ++i) {
      EXPECT_THAT(by_worker[i], ElementsAre(cores[i]));
    }
  });
}

TEST(Pinning, OfCoresThatDoNotExistLeavesAllFree) {
  onAnotherThread([] {
    const std::vector<int> usable = usableCores();
    ThreadTeam team(2);
    EXPECT_FALSE(team.pin(std::vector{usable.front(), CPU_SETSIZE - 1}, usable));
    EXPECT_FALSE(team.pin({}, usable));
    const auto by_worker = usableByWorker(team);
    EXPECT_EQ(by_worker[0], usable);
    EXPECT_EQ(by_worker[1].size(), std::max<std::size_t>(usable.size(), 2) - 1);
  });
}

// On any core of the caller, also after it has migrated; if there are enough cores.
TEST(ThreadTeam, KeepsItsWorkersOffTheCallersCore) {
  onAnotherThread([] {
    const std::vector<int> usable = usableCores();
    if (usable.size() < 2) GTEST_SKIP() << "there is one core only";
    ThreadTeam team(2);
    ThreadTeam large(static_cast<int>(usable.size()) + 1);
    for (const int core : usable) {
      cpu_set_t set;
      CPU_ZERO(&set);
      CPU_SET(core, &set);
      if (::pthread_setaffinity_np(::pthread_self(), sizeof set, &set) != 0) {
        GTEST_SKIP() << "this system allows no pinning";
      }
      std::vector<int> others = usable;
      std::erase(others, core);
      EXPECT_EQ(usableByWorker(team)[1], others);
      EXPECT_EQ(usableByWorker(large)[1], usable);
    }
  });
}

TEST(Pinning, OfACaseWhoseThreadsFitTheCores) {
  const int cores = static_cast<int>(usableCores().size());
  ChainSource source;
  const Frame first = source.rewind();
  const auto pinned = [&](int threads, bool pin, bool on_device) {
    bool is_pinned = false;
    onAnotherThread([&] {
      Case test_case = caseOf({.traits = {.on_device = on_device}});
      test_case.threads = threads;
      InProcessExecutor host(test_case, pin);
      host.start(source.scene(), first);
      is_pinned = host.report().pinned;
      if (!is_pinned) {
        EXPECT_EQ(usableCores().size(), static_cast<std::size_t>(cores));
      }
      host.stop();
    });
    return is_pinned;
  };
  EXPECT_FALSE(pinned(1, false, false));
  EXPECT_TRUE(pinned(1, true, false));
  EXPECT_TRUE(pinned(cores, true, false));
  EXPECT_FALSE(pinned(cores + 1, true, false));
  EXPECT_FALSE(pinned(1, true, true));
}

}  // namespace
}  // namespace broadmark::tests
