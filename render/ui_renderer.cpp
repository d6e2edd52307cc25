#include "broadmark/render/ui_renderer.h"

#include <imgui.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "render_assets.h"

namespace broadmark {
namespace {

/// An offset as a pointer, as required by OpenGL.
const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);  // NOLINT(performance-no-int-to-ptr)
}

GLuint textureName(void* id) { return static_cast<GLuint>(reinterpret_cast<std::uintptr_t>(id)); }

}  // namespace

UiRenderer::UiRenderer(const Gl& gl)
    : gl_(&gl),
      program_(makeProgram(gl, render_assets::ui_vert(), render_assets::ui_frag())),
      vertex_array_(makeObject(gl.GenVertexArrays, gl.DeleteVertexArrays)),
      vertices_(makeObject(gl.GenBuffers, gl.DeleteBuffers)),
      indices_(makeObject(gl.GenBuffers, gl.DeleteBuffers)) {
  gl.BindVertexArray(vertex_array_.get());
  gl.BindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
  for (GLuint location = 0; location < 3; ++location) gl.EnableVertexAttribArray(location);
  gl.check("preparing the user interface");
}

void UiRenderer::setFirstVertex(std::size_t vertex) const {
  const auto attribute = [&](GLuint location, GLint count, GLenum type, GLboolean normalised,
                             std::size_t at) {
    gl_->VertexAttribPointer(location, count, type, normalised, sizeof(ImDrawVert),
                             offset(vertex * sizeof(ImDrawVert) + at));
  };
  attribute(0, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, pos));
  attribute(1, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, uv));
  attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ImDrawVert, col));
}

void UiRenderer::uploadFonts(ImFontAtlas& atlas) {
  unsigned char* pixels = nullptr;
  int width = 0;
  int height = 0;
  atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
  font_texture_ = makeObject(gl_->GenTextures, gl_->DeleteTextures);
  gl_->BindTexture(GL_TEXTURE_2D, font_texture_.get());
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
  gl_->check("uploading the letters");
  atlas.SetTexID(uiTexture(font_texture_.get()));
}

void UiRenderer::draw(const ImDrawData& data) {
  gl_->Viewport(0, 0, static_cast<GLsizei>(data.DisplaySize.x),
                static_cast<GLsizei>(data.DisplaySize.y));
  gl_->Disable(GL_DEPTH_TEST);
  gl_->Enable(GL_BLEND);
  gl_->BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl_->Enable(GL_SCISSOR_TEST);
  gl_->UseProgram(program_.get());
  gl_->Uniform2f(gl_->GetUniformLocation(program_.get(), "viewport"), data.DisplaySize.x,
                 data.DisplaySize.y);
  gl_->BindVertexArray(vertex_array_.get());
  gl_->BindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    gl_->BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data,
                    GL_STREAM_DRAW);
    gl_->BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                    GL_STREAM_DRAW);
    unsigned first_vertex = 0;
    setFirstVertex(first_vertex);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback != nullptr) continue;
      if (std::exchange(first_vertex, command.VtxOffset) != command.VtxOffset) {
        setFirstVertex(first_vertex);
      }
      drawCommand(command, data);
    }
  }
  gl_->Disable(GL_SCISSOR_TEST);
  gl_->Disable(GL_BLEND);
  gl_->check("drawing the user interface");
}

void UiRenderer::drawCommand(const ImDrawCmd& command, const ImDrawData& data) const {
  const ImVec4& clip = command.ClipRect;
  const float left = std::max(clip.x, 0.0F);
  const float top = std::max(clip.y, 0.0F);
  const float right = std::min(clip.z, data.DisplaySize.x);
  const float bottom = std::min(clip.w, data.DisplaySize.y);
  if (right <= left || bottom <= top) return;
  gl_->Scissor(static_cast<GLint>(left), static_cast<GLint>(data.DisplaySize.y - bottom),
               static_cast<GLsizei>(right - left), static_cast<GLsizei>(bottom - top));
  gl_->BindTexture(GL_TEXTURE_2D, textureName(command.TextureId));
  gl_->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
                    sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                    offset(command.IdxOffset * sizeof(ImDrawIdx)));
}

}  // namespace broadmark
