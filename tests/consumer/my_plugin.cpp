// A custom broad phase, as a library that Broadmark loads.

#include <broadmark/plugin.h>

#include <memory>
#include <vector>

#include "all_pairs.h"

namespace {

/// Tests every pair of boxes, with the boxes as arrays, on all threads.
class ParallelAllPairs final : public broadmark::SimdBroadPhase {
  void findPairs() override {
    team().run([&](int worker) {
      const auto [first, last] = broadmark::share(arrays().size(), team().size(), worker);
      for (std::size_t a = first; a < last; ++a) {
        for (std::size_t b = a + 1; b < arrays().size(); ++b) {
          if (broadmark::overlaps(arrays().box(a), arrays().box(b))) {
            pairs(worker).add(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
          }
        }
      }
    });
  }
};

std::vector<broadmark::Algorithm> variants() {
  return {{.id = "mine", .family = "Mine", .create = [] { return std::make_unique<AllPairs>(); }},
          {.id = "mine-mt", .family = "Mine", .traits = {.parallel = true}, .create = [] {
             return std::make_unique<ParallelAllPairs>();
           }}};
}

}  // namespace

BROADMARK_PLUGIN(variants);
