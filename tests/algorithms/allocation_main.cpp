// Checks that the steady state of an algorithm allocates nothing. A separate program, as it
// replaces malloc.
//
// Skips algorithms with a library that allocates (by their traits).

#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "algorithms/runs.h"
#include "broadphase/query_oracle.h"
#include "support/changing_worlds.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define BROADMARK_COUNTS_ALLOCATIONS 0
#else
#define BROADMARK_COUNTS_ALLOCATIONS 1
#endif

namespace {

std::atomic<long> allocations{0};

}  // namespace

#if BROADMARK_COUNTS_ALLOCATIONS
// operator new, aligned or not, calls these too.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  ++allocations;
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  ++allocations;
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
}
#endif

namespace {

using namespace broadmark;
using namespace broadmark::tests;

/// The algorithms without allocations by a library.
std::vector<Algorithm> allocationFreeAlgorithms() {
  std::vector<Algorithm> algorithms = pairFinders();
  std::erase_if(algorithms, [](const Algorithm& a) { return a.traits.library_allocates; });
  return algorithms;
}

/// Allocations while the same frames are repeated. The boxes move, so that incremental algorithms
/// have work to do.
long allocationsPerRound(const Algorithm& algorithm, const Configuration& config,
                         std::size_t bodies, const CollisionFilter& filter = {},
                         bool filter_changes = false) {
  constexpr int kRoundsBefore = 12;  // until no algorithm tries another mode
  const auto frames = framesOf({"drifting", inputs::drifting}, bodies, 6);
  SceneInfo scene = sceneOf(frames);
  scene.filter = filter;
  scene.filter_changes = filter_changes;
  TestRun test_run(algorithm, config);
  test_run.start(scene, frames[0]);
  long before = 0;
  for (int round = 0; round <= kRoundsBefore; ++round) {
    before = allocations;
    for (const std::vector<Aabb>& boxes : frames) {
      test_run.step(boxes, filter_changes ? &scene.filter : nullptr);  // accumulates events, too
    }
  }
  return allocations - before;
}

/// Skips where a sanitizer owns malloc.
class SteadyState : public testing::TestWithParam<Algorithm> {
 protected:
  void SetUp() override {
    if (BROADMARK_COUNTS_ALLOCATIONS == 0) GTEST_SKIP() << "allocations cannot be counted here";
  }
};

// Otherwise the tests below would always pass.
TEST(SteadyStateCheck, CounterSeesAllocations) {
  if (BROADMARK_COUNTS_ALLOCATIONS == 0) GTEST_SKIP() << "allocations cannot be counted here";
  const long before = allocations;
  const std::vector<int> some(1000, static_cast<int>(before));
  void* const aligned = std::aligned_alloc(64, 640);
  EXPECT_GE(allocations, before + 2) << some.data() << aligned;
  std::free(aligned);
}

TEST_P(SteadyState, AllocatesNothing) {
  for (const Configuration& config : allConfigurations(GetParam())) {
    EXPECT_EQ(allocationsPerRound(GetParam(), config, 2000), 0) << describe(GetParam(), config);
  }
}

TEST_P(SteadyState, AllocatesNothingInSeveralWorlds) {
  constexpr std::size_t kBodies = 300;
  const CollisionFilter filter =
      filterOf(kBodies, LayerMatrix().set(0, 0),
               [](inputs::Random&, std::uint32_t body) { return BodyGroups{.world = body % 5}; });
  for (const Configuration& config : allConfigurations(GetParam())) {
    EXPECT_EQ(allocationsPerRound(GetParam(), config, kBodies, filter), 0)
        << describe(GetParam(), config);
  }
}

// Frames in which no filter changes, where filters may.
TEST_P(SteadyState, AllocatesNothingWhileFiltersRest) {
  constexpr std::size_t kBodies = 500;
  const CollisionFilter filter =
      filterOf(kBodies, LayerMatrix().set(0, 1).set(1, 1), [](inputs::Random&, std::uint32_t body) {
        return BodyGroups{.layer = std::uint8_t{body % 3 == 0}};
      });
  for (const Configuration& config : allConfigurations(GetParam())) {
    EXPECT_EQ(allocationsPerRound(GetParam(), config, kBodies, filter, true), 0)
        << describe(GetParam(), config);
  }
}

// The library for engines, with bodies that come and go, listed changes, saved states and queries.
TEST(SteadyStateOfTheLibrary, AllocatesNothing) {
  if (BROADMARK_COUNTS_ALLOCATIONS == 0) GTEST_SKIP() << "allocations cannot be counted here";
  constexpr std::size_t kBodies = 5000;
  std::vector<std::vector<bp::Box>> frames;
  for (std::uint32_t frame = 0; frame < 6; ++frame) {
    BoxList boxes = inputs::drifting(kBodies, frame, 1);
    for (std::size_t body = frame; body < kBodies; body += 50) boxes[body] = kEmptyBox;
    frames.push_back(publicBoxes(boxes));
  }
  std::vector<std::uint32_t> all(kBodies);
  std::iota(all.begin(), all.end(), 0U);
  std::vector<std::byte> state;
  QueryBatches batches;
  for (const bp::Box& box : frames[0]) {
    if (box.min[0] > box.max[0] || batches.boxes.size() == 100) continue;
    batches.boxes.push_back({box});
    batches.casts.push_back({box, {1, 2, 3}});
    batches.points.push_back({{box.min[0], box.min[1], box.min[2]}, 5});
  }
  for (bp::Options options : allOptions()) {
    for (const int threads : {1, 2, 3}) {
      options.threads = threads;
      options.parallel_for = threads == 3 ? runBackwards : bp::ParallelFor();
      bp::BroadPhase object(options);
      long before = allocations;
      object.update(frames[0]);
      EXPECT_GT(allocations, before) << "its allocations are not seen";
      for (int round = 0; round <= 3; ++round) {
        before = allocations;
        for (const std::vector<bp::Box>& boxes : frames) object.update(boxes);
        for (const std::vector<bp::Box>& boxes : frames) {
          object.update(boxes, all);
          batches.run(object);
        }
        object.save(state);
      }
      EXPECT_EQ(allocations - before, 0) << describe(options);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Algorithms, SteadyState, testing::ValuesIn(allocationFreeAlgorithms()),
                         [](const auto& tested) { return testName(tested.param); });

}  // namespace
