#include "primitive_renderer.h"

#include <algorithm>

#include "broadmark/render/colour.h"
#include "render_assets.h"
#include "shading.h"

namespace broadmark {
namespace {

constexpr GLsizei kTexelsPerPrimitive = 2;
constexpr GLsizei kPrimitivesPerRow = 1024;  // the sides of a texture are limited
constexpr GLsizei kRowTexels = kTexelsPerPrimitive * kPrimitivesPerRow;

std::size_t batchSize(const Gl& gl, int vertices_per_primitive, std::size_t requested) {
  const auto rows = static_cast<std::size_t>(gl.integer(GL_MAX_TEXTURE_SIZE));
  // gl_VertexID is a signed 32-bit integer.
  const auto vertices = static_cast<std::size_t>(std::numeric_limits<GLsizei>::max());
  return std::max<std::size_t>(
      1, std::min({requested, rows * kPrimitivesPerRow,
                   vertices / static_cast<std::size_t>(vertices_per_primitive)}));
}

}  // namespace

PrimitiveRenderer::PrimitiveRenderer(const Gl& gl, std::string_view vertex_source,
                                     std::string_view fragment_source, int vertices_per_primitive,
                                     std::size_t max_batch)
    : gl_(&gl),
      program_(makeProgram(gl, vertex_source, fragment_source)),
      vertex_array_(makeObject(gl.GenVertexArrays, gl.DeleteVertexArrays)),
      vertices_per_primitive_(vertices_per_primitive),
      batch_size_(batchSize(gl, vertices_per_primitive, max_batch)) {}

PrimitiveBuffer PrimitiveRenderer::upload(std::span<const Primitive> primitives) const {
  PrimitiveBuffer buffer;
  for (; !primitives.empty();
       primitives = primitives.subspan(std::min(batch_size_, primitives.size()))) {
    buffer.batches_.push_back(
        makeBatch(primitives.first(std::min(batch_size_, primitives.size()))));
  }
  gl_->check("uploading boxes and lines");
  return buffer;
}

PrimitiveBuffer::Batch PrimitiveRenderer::makeBatch(std::span<const Primitive> primitives) const {
  const auto count = static_cast<GLsizei>(primitives.size());
  PrimitiveBuffer::Batch batch{makeObject(gl_->GenTextures, gl_->DeleteTextures),
                               count * vertices_per_primitive_};
  const GLsizei rows = count / kPrimitivesPerRow;
  const GLsizei rest = count % kPrimitivesPerRow;
  gl_->BindTexture(GL_TEXTURE_2D, batch.texture.get());
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kRowTexels, rows + (rest > 0 ? 1 : 0), 0, GL_RGBA,
                  GL_FLOAT, nullptr);
  gl_->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kRowTexels, rows, GL_RGBA, GL_FLOAT,
                     primitives.data());
  gl_->TexSubImage2D(GL_TEXTURE_2D, 0, 0, rows, kTexelsPerPrimitive * rest, rest > 0 ? 1 : 0,
                     GL_RGBA, GL_FLOAT, primitives.last(static_cast<std::size_t>(rest)).data());
  return batch;
}

PrimitiveRenderer boxRenderer(const Gl& gl, std::size_t max_batch) {
  constexpr int kVertices = 18;  // three faces of two triangles
  PrimitiveRenderer renderer(gl, render_assets::box_vert(), render_assets::box_frag(), kVertices,
                             max_batch);
  renderer.use();
  gl.Uniform3f(renderer.uniform("light"), kBoxShading.light[0], kBoxShading.light[1],
               kBoxShading.light[2]);
  gl.Uniform1f(renderer.uniform("underside"), kBoxShading.underside);
  gl.Uniform1f(renderer.uniform("edge_darkness"), kBoxShading.edge_darkness);
  gl.Uniform1f(renderer.uniform("foot_darkness"), kBoxShading.foot_darkness);
  gl.Uniform1f(renderer.uniform("most_haze"), kBoxShading.haze);
  gl.Uniform2f(renderer.uniform("haze_range"), -kBoxShading.haze_before, kBoxShading.haze_behind);
  return renderer;
}

PrimitiveRenderer lineRenderer(const Gl& gl) {
  constexpr int kVertices = 6;
  PrimitiveRenderer renderer(gl, render_assets::line_vert(), render_assets::line_frag(), kVertices);
  renderer.use();
  gl.Uniform1f(renderer.uniform("lift"), kLineShading.lift);
  return renderer;
}

GLint PrimitiveRenderer::uniform(const char* name) const {
  return gl_->GetUniformLocation(program_.get(), name);
}

void PrimitiveRenderer::draw(const PrimitiveBuffer& primitives, const Viewpoint& viewpoint,
                             float opacity) const {
  // A uniform that the shader does not use has location -1; setting it has no effect.
  const Camera& camera = viewpoint.camera;
  const std::array haze = components(viewpoint.haze);
  use();
  gl_->UniformMatrix4fv(uniform("view_projection"), 1, GL_FALSE, viewProjection(camera).data());
  gl_->Uniform3f(uniform("eye"), camera.eye[0], camera.eye[1], camera.eye[2]);
  gl_->Uniform1f(uniform("focus"), focus(camera));
  gl_->Uniform1f(uniform("pixel"), pixelSize(camera, viewpoint.height));
  gl_->Uniform1f(uniform("edge_pixels"), edgePixels(viewpoint.height));
  gl_->Uniform1f(uniform("opacity"), opacity);
  gl_->Uniform2f(uniform("viewport"), static_cast<float>(viewpoint.width),
                 static_cast<float>(viewpoint.height));
  gl_->Uniform3f(uniform("haze"), haze[0], haze[1], haze[2]);

  gl_->BindVertexArray(vertex_array_.get());
  for (const PrimitiveBuffer::Batch& batch : primitives.batches_) {
    gl_->BindTexture(GL_TEXTURE_2D, batch.texture.get());
    gl_->DrawArrays(GL_TRIANGLES, 0, batch.vertices);
  }
  gl_->check("drawing boxes and lines");
}

}  // namespace broadmark
