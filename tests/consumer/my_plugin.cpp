// A broad phase of one's own, as a library that Broadmark loads.

#include <broadmark/plugin.h>

#include <memory>

namespace {

/// Tests each box against each.
class MyBroadPhase final : public broadmark::BoxBroadPhase {
 public:
  void searchOverlaps() override {
    for (std::uint32_t a = 0; a < boxes().size(); ++a) {
      for (std::uint32_t b = a + 1; b < boxes().size(); ++b) {
        if (broadmark::overlaps(boxes()[a], boxes()[b])) pairs().add(a, b);
      }
    }
    publishPairs();
  }
};

/// The same with the boxes as arrays, on all threads.
class MyParallelBroadPhase final : public broadmark::SimdBroadPhase {
 public:
  void searchOverlaps() override {
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
    publishPairs();
  }
};

std::vector<broadmark::Algorithm> variants() {
  return {
      {.id = "mine", .family = "Mine", .create = [] { return std::make_unique<MyBroadPhase>(); }},
      {.id = "mine-mt", .family = "Mine", .parallel = true, .create = [] {
         return std::make_unique<MyParallelBroadPhase>();
       }}};
}

}  // namespace

BROADMARK_PLUGIN(variants);
