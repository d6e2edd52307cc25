// Single: one body.

#include "broadmark/scenes/brush.h"
#include "entries.h"

namespace broadmark::scenes::single_brush {
namespace {

class SingleBrush final : public Brush {
 public:
  [[nodiscard]] double count(double) const override { return 1; }
  [[nodiscard]] Vec3 place(std::size_t, Random&) const override { return {}; }
};

}  // namespace

BrushEntry entry() { return {{"single", "one body"}, makeAs<Brush, SingleBrush>}; }

}  // namespace broadmark::scenes::single_brush
