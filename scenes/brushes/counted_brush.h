// What the brushes share whose number of bodies is a parameter.
#pragma once

#include "broadmark/scenes/brush.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark::scenes {

template <std::int64_t default_count>
class CountedBrush : public Brush {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"count", "number of bodies", &count_, 1, kMostBodies});
  }
  [[nodiscard]] double count(double) const override { return static_cast<double>(count_); }

 private:
  std::int64_t count_ = default_count;
};

}  // namespace broadmark::scenes
