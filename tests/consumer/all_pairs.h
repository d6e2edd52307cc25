// A custom broad phase that tests every pair of boxes.
#pragma once

#include <broadmark/broad_phase.h>

#include <cstdint>

class AllPairs final : public broadmark::BoxBroadPhase {
  void findPairs() override {
    for (std::uint32_t a = 0; a < boxes().size(); ++a) {
      for (std::uint32_t b = a + 1; b < boxes().size(); ++b) {
        if (broadmark::overlaps(boxes()[a], boxes()[b])) pairs().add(a, b);
      }
    }
  }
};
