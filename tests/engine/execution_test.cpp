// Work sharing, thread teams, instruction sets.

#include "broadmark/execution.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "broadmark/reference_pairs.h"
#include "engine/helpers.h"
#include "torture/inputs.h"

namespace broadmark::tests {
namespace {

TEST(Share, CoversEverythingOnceInNearlyEqualParts) {
  for (const std::size_t count : {0U, 1U, 7U, 8U, 1000U, 1009U}) {
    for (int parts = 1; parts <= 9; ++parts) {
      std::size_t end = 0;
      for (int part = 0; part < parts; ++part) {
        const auto [first, second] = share(count, parts, part);
        EXPECT_EQ(first, end);
        EXPECT_LE(second - first, count / static_cast<std::size_t>(parts) + 1);
        EXPECT_GE(second - first, count / static_cast<std::size_t>(parts));
        end = second;
      }
      EXPECT_EQ(end, count);
    }
  }
}

TEST(ThreadTeam, EveryWorkerRunsOnceInItsOwnThread) {
  for (int size = 1; size <= 8; ++size) {
    ThreadTeam team(size);
    ASSERT_EQ(team.size(), size);
    std::mutex guard;
    std::multiset<int> workers;
    std::set<std::thread::id> threads;
    std::thread::id caller_ran_as;
    team.run([&](int worker) {
      const std::lock_guard hold(guard);
      workers.insert(worker);
      threads.insert(std::this_thread::get_id());
      if (worker == 0) caller_ran_as = std::this_thread::get_id();
    });
    EXPECT_EQ(workers.size(), static_cast<std::size_t>(size));
    for (int worker = 0; worker < size; ++worker) EXPECT_EQ(workers.count(worker), 1U);
    EXPECT_EQ(threads.size(), static_cast<std::size_t>(size));
    EXPECT_EQ(caller_ran_as, std::this_thread::get_id());
  }
}

// Workers write plain memory and the caller reads it: run() synchronises the two.
TEST(ThreadTeam, ManyShortRunsLoseNothing) {
  for (const int size : {2, 3, 5}) {
    ThreadTeam team(size);
    std::vector<int> counts(static_cast<std::size_t>(size));
    int sum = 0;
    constexpr int kRuns = kSanitized ? 500 : 5000;
    for (int round = 0; round < kRuns; ++round) {
      team.run([&](int worker) { ++counts[static_cast<std::size_t>(worker)]; });
      sum = 0;
      for (const int count : counts) sum += count;
      ASSERT_EQ(sum, (round + 1) * size);
    }
  }
}

// After zero to two calls of wake(), also after workers have fallen asleep again.
TEST(ThreadTeam, RunsOnceAWakeUp) {
  const std::vector<Aabb> boxes = inputs::uniform(2000, 1, 1);
  for (const int size : {1, 2, 3, 5}) {
    ThreadTeam team(size);
    constexpr int kRuns = kSanitized ? 100 : 1000;
    for (int round = 0; round < kRuns; ++round) {
      for (int i = 0; i < round % 3; ++i) team.wake();
      if (round % 100 == 99) bruteForcePairs(boxes);  // takes longer than workers stay awake
      std::atomic<int> ran = 0;
      team.run([&](int) { ++ran; });
      ASSERT_EQ(ran, size);
    }
    team.wake();  // and is destroyed
  }
}

// Others sleep on, and miss no later job.
TEST(ThreadTeam, RunsOnSomeOfItsWorkers) {
  ThreadTeam team(5);
  std::vector<int> counts(5);
  std::vector<int> expected(5);
  for (int round = 0; round < (kSanitized ? 200 : 2000); ++round) {
    const int workers = 1 + round * 7 % 5;
    if (round % 3 == 0) team.wake(1 + round % 5);
    team.runOn(workers, [&](int worker) { ++counts[static_cast<std::size_t>(worker)]; });
    for (int worker = 0; worker < workers; ++worker) ++expected[static_cast<std::size_t>(worker)];
    ASSERT_EQ(counts, expected) << workers;
  }
}

TEST(WorkersThatPay, HaveSharesLongerThanAWakeUp) {
  EXPECT_EQ(workersThatPay(0, 4), 1);
  EXPECT_EQ(workersThatPay(1.9 * kMinShareNs, 4), 1);
  EXPECT_EQ(workersThatPay(2 * kMinShareNs, 4), 2);
  EXPECT_EQ(workersThatPay(3.5 * kMinShareNs, 4), 3);
  EXPECT_EQ(workersThatPay(1e300, 4), 4);
  EXPECT_EQ(workersThatPay(0, 4, 0), 4) << "the minimum can be switched off";
}

TEST(ThreadTeam, RethrowsWhicheverWorkerFailsAndGoesOn) {
  ThreadTeam team(4);
  for (int failing = 0; failing < 4; ++failing) {
    std::atomic<int> finished = 0;
    try {
      team.run([&](int worker) {
        if (worker == failing) throw std::runtime_error(std::to_string(worker));
        ++finished;
      });
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), std::to_string(failing));
    }
    EXPECT_EQ(finished, 3) << "the others finish first";
  }
  EXPECT_THROW(team.run([](int) { throw std::logic_error("all of them"); }), std::logic_error);
  std::atomic<int> ran = 0;
  team.run([&](int) { ++ran; });
  EXPECT_EQ(ran, 4);
}

TEST(ThreadTeam, RunsJobsOnThreadsOfTheCaller) {
  int calls = 0;
  ThreadTeam team(3, [&](int workers, const std::function<void(int)>& job) {
    ++calls;
    for (int worker = workers; worker-- > 0;) job(worker);
  });
  ASSERT_EQ(team.size(), 3);
  team.wake();
  std::vector<int> ran;
  team.run([&](int worker) { ran.push_back(worker); });
  EXPECT_EQ(ran, (std::vector<int>{2, 1, 0}));
  EXPECT_THROW(team.run([&](int worker) {
    ran.push_back(worker);
    if (worker == 2) throw std::runtime_error("failed");
  }),
               std::runtime_error);
  EXPECT_EQ(ran.size(), 6U);
  team.run([&](int worker) { ran.push_back(worker); });
  EXPECT_EQ(ran.size(), 9U);
  EXPECT_EQ(calls, 3);
}

TEST(ThreadTeam, MadeAndDestroyedUnused) {
  for (int i = 0; i < 50; ++i) const ThreadTeam team(1 + i % 8);
}

// Too many threads for the system are a reportable error; they do not terminate the program.
TEST(ThreadTeamDeathTest, TooManyThreadsThrow) {
  if (kSanitized) GTEST_SKIP() << "sanitizers reserve more memory than the limit set here";
  const auto start_many = [] {
    const rlimit address_space = {std::uint64_t{1} << 30, std::uint64_t{1} << 30};
    ::setrlimit(RLIMIT_AS, &address_space);
    try {
      const ThreadTeam team(1000);
    } catch (const std::system_error&) {
      std::exit(3);
    }
    std::exit(4);
  };
  EXPECT_EXIT(start_many(), testing::ExitedWithCode(3), "");
}

TEST(Isa, NamesAreDistinctAndScalarAlwaysRuns) {
  std::set<std::string_view> names;
  for (const auto& [isa, name] : kIsas.entries) names.insert(name);
  EXPECT_EQ(names,
            (std::set<std::string_view>{"scalar", "sse2", "neon", "simd128", "avx2", "avx512"}));
  EXPECT_TRUE(isaSupported(Isa::scalar));
}

TEST(Isa, TheBestIsTheWidestSupported) {
  EXPECT_TRUE(isaSupported(bestIsa()));
  for (const auto& [isa, name] : kIsas.entries) {
    EXPECT_FALSE(isa > bestIsa() && isaSupported(isa)) << name;
  }
}

}  // namespace
}  // namespace broadmark::tests
