// Brute force that searches each frame SEARCHES times: a build with another number is slower or
// faster, whatever the machine; one with none finds nothing. A plug-in, never part of the program.

#include <cstddef>
#include <cstdint>
#include <memory>

#include "broadmark/plugin.h"

namespace broadmark::repeated {
namespace {

class RepeatedSearch final : public BoxBroadPhase {
  void findPairs() override {
    for (int search = 1; search < SEARCHES; ++search) {
      std::size_t count = 0;
      visitPairs([&](std::uint32_t, std::uint32_t) { ++count; });
      discarded_ = count;
    }
    if (SEARCHES == 0) return;
    visitPairs([&](std::uint32_t a, std::uint32_t b) { pairs().add(a, b); });
  }

  template <class Visit>
  void visitPairs(Visit&& visit) {
    for (std::uint32_t b = 0; b < boxes().size(); ++b) {
      for (std::uint32_t a = 0; a < b; ++a) {
        if (broadmark::overlaps(boxes()[a], boxes()[b])) visit(a, b);
      }
    }
  }

  volatile std::size_t discarded_ = 0;  ///< keeps the compiler from skipping searches
};

}  // namespace

std::vector<Algorithm> variants() {
  return {{.id = "repeated-search",
           .family = "Tests",
           .summary = "searches each frame several times",
           .traits = {},
           .description = {.principle = "brute force",
                           .optimisations = "",
                           .time = "O(n²)",
                           .space = "O(n + k)",
                           .source = "a test of Broadmark's, slow on purpose"},
           .create = [] { return std::make_unique<RepeatedSearch>(); }}};
}

}  // namespace broadmark::repeated

BROADMARK_PLUGIN(broadmark::repeated::variants);
