#include "box_renderer.h"

#include "look.h"
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
  use();
  gl.Uniform1f(uniform("lift"), kLineLook.lift);
}

}  // namespace broadmark
