#include "box_renderer.h"

#include <algorithm>
#include <cmath>

#include "box_look.h"
#include "render_assets.h"

namespace broadmark {
namespace {

constexpr int kBoxVertices = 18;  // three faces of two triangles
constexpr int kLineVertices = 6;

}  // namespace

BoxRenderer::BoxRenderer(const Gl& gl, std::size_t max_batch)
    : PrimitiveRenderer(gl, render_assets::box_vert(), render_assets::box_frag(), kBoxVertices,
                        max_batch) {
  use();
  gl.Uniform3f(uniform("light"), kBoxLook.light[0], kBoxLook.light[1], kBoxLook.light[2]);
  gl.Uniform1f(uniform("underside"), kBoxLook.underside);
  gl.Uniform1f(uniform("edge_darkness"), kBoxLook.edge_darkness);
  gl.Uniform1f(uniform("foot_darkness"), kBoxLook.foot_darkness);
  gl.Uniform1f(uniform("most_haze"), kBoxLook.haze);
  gl.Uniform2f(uniform("haze_range"), -kBoxLook.haze_before, kBoxLook.haze_behind);
}

LineRenderer::LineRenderer(const Gl& gl)
    : PrimitiveRenderer(gl, render_assets::line_vert(), render_assets::line_frag(), kLineVertices) {
}

Primitive boxPrimitive(const Aabb& box, Rgb colour, const ViewSpace& space, float width) {
  return {space.toView(box.min), static_cast<float>(colour), space.toView(box.max), width};
}

std::vector<Primitive> wireframe(const Aabb& box, Rgb colour, float width, const ViewSpace& space) {
  const std::array ends = {space.toView(box.min), space.toView(box.max)};
  const auto corner = [&](std::size_t index) {
    return std::array{ends[index & 1][0], ends[(index >> 1) & 1][1], ends[(index >> 2) & 1][2]};
  };
  std::vector<Primitive> edges;
  for (std::size_t from = 0; from < 8; ++from) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t to = from | (std::size_t{1} << axis);
      if (to == from) continue;
      edges.push_back({corner(from), static_cast<float>(colour), corner(to), width});
    }
  }
  return edges;
}

std::vector<Primitive> floorGrid(const Aabb& box, Rgb colour, float width, const ViewSpace& space) {
  constexpr float kSquares = 10;
  const std::array low = space.toView(box.min);
  const std::array high = space.toView(box.max);
  const float step = std::max(high[0] - low[0], high[2] - low[2]) / kSquares;
  std::vector<Primitive> lines;
  if (!(step > 0)) return lines;
  for (const auto& [along, across] : {std::pair<std::size_t, std::size_t>{0, 2}, {2, 0}}) {
    const int count = static_cast<int>(std::floor((high[across] - low[across]) / step + 0.001F));
    for (int i = 1; i <= count; ++i) {
      // The line on the far wall is an edge of the world.
      const float at = low[across] + static_cast<float>(i) * step;
      if (at > high[across] - 0.001F * step) break;
      std::array<float, 3> from = low;
      from[across] = at;
      std::array<float, 3> to = from;
      to[along] = high[along];
      lines.push_back({from, static_cast<float>(colour), to, width});
    }
  }
  return lines;
}

}  // namespace broadmark
