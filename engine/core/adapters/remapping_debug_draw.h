// Maps body indices in an algorithm's drawing back to the scene's.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "broadmark/debug_draw.h"

namespace broadmark {

/// Forwards a drawing, with body indices mapped to the scene's.
class RemappingDebugDraw final : public DebugDraw {
 public:
  /// `bodies`: the scene's body for each of the algorithm's; borrowed.
  RemappingDebugDraw(DebugDraw& draw, std::span<const std::uint32_t> bodies)
      : draw_(draw), bodies_(bodies) {}

  void box(const Aabb& box, StructureRole role, int level) override { draw_.box(box, role, level); }
  void line(const std::array<float, 3>& from, const std::array<float, 3>& to,
            StructureRole role) override {
    draw_.line(from, to, role);
  }
  void cell(const Aabb& bounds, int level, std::uint32_t population) override {
    draw_.cell(bounds, level, population);
  }
  void tests(std::uint32_t body, std::uint32_t count) override {
    if (body < bodies_.size()) draw_.tests(bodies_[body], count);
  }

 private:
  DebugDraw& draw_;
  std::span<const std::uint32_t> bodies_;
};

}  // namespace broadmark
