// Checks that the steady state of an algorithm allocates nothing. A program of its own, as it puts
// itself between everybody and malloc. Exit status 0: nothing was allocated; 1: something was.
//
// Families that wrap a library are not ours to answer for, and are left out.

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "tests/algorithms/runs.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define BROADMARK_COUNTS_ALLOCATIONS 0
#else
#define BROADMARK_COUNTS_ALLOCATIONS 1
#endif

namespace {

std::atomic<long> allocations{0};

}  // namespace

#if BROADMARK_COUNTS_ALLOCATIONS
// operator new, aligned or not, comes through here too.
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

bool wrapsLibrary(const Algorithm& algorithm) {
  constexpr std::array kFamilies = {"AxisSweep", "DBVT", "CGAL", "GPU"};
  return std::ranges::count(kFamilies, algorithm.family) > 0;
}

/// Allocations while the same frames come around once more. The boxes move, so that incremental
/// algorithms have work to do.
long allocationsPerRound(const Algorithm& algorithm, const Configuration& way) {
  constexpr int kRoundsBefore = 3;
  const auto frames = framesOf({"drifting", inputs::drifting}, 2000, 6);
  Execution execution(way.threads, way.isa);
  Instance run(algorithm, execution, sceneOf(frames), frames[0]);
  long before = 0;
  for (int round = 0; round <= kRoundsBefore; ++round) {
    before = allocations;
    for (const std::vector<Aabb>& boxes : frames) run.step(boxes);
  }
  return allocations - before;
}

/// Whether allocations are seen at all: else the test would always pass.
bool counterWorks() {
  const long before = allocations;
  const std::vector<int> some(1000);
  void* const aligned = std::aligned_alloc(64, 640);
  std::free(aligned);
  return allocations >= before + 2 && !some.empty();
}

}  // namespace

int main() {
  if (BROADMARK_COUNTS_ALLOCATIONS == 0) {
    std::puts("skipped: allocations cannot be counted in this build");
    return EXIT_SUCCESS;
  }
  if (!counterWorks()) {
    std::puts("the counter does not see allocations");
    return EXIT_FAILURE;
  }
  bool clean = true;
  for (const Algorithm& algorithm : pairFinders()) {
    if (wrapsLibrary(algorithm)) continue;
    for (const Configuration& way : configurations(algorithm)) {
      const long count = allocationsPerRound(algorithm, way);
      if (count == 0) continue;
      clean = false;
      std::printf("%s: %ld allocations in its steady state\n", describe(algorithm, way).c_str(),
                  count);
    }
  }
  if (clean) std::puts("no algorithm allocates in its steady state");
  return clean ? EXIT_SUCCESS : EXIT_FAILURE;
}
