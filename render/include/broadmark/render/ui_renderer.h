// Draws Dear ImGui's lists with our function table, in windows and off-screen. The loader of Dear
// ImGui's OpenGL backend does not work with OSMesa.
#pragma once

#include "broadmark/render/gl.h"

struct ImDrawData;
struct ImDrawCmd;
struct ImFontAtlas;

namespace broadmark {

/// Requires its context to be current during its lifetime. Textures are identified by
/// their GL names: ImGui::Image(uiTexture(id), …).
class UiRenderer {
 public:
  explicit UiRenderer(const Gl& gl);

  /// Creates a texture of the atlas. Must be called again after changes of the fonts.
  void uploadFonts(ImFontAtlas& atlas);
  /// Draws into the current framebuffer.
  void draw(const ImDrawData& data);

 private:
  /// Makes a vertex of the buffer the first one, which indices count from.
  void setFirstVertex(std::size_t vertex) const;
  void drawCommand(const ImDrawCmd& command, const ImDrawData& data) const;

  const Gl* gl_;
  GlObject program_;
  GlObject vertex_array_;
  GlObject vertices_;
  GlObject indices_;
  GlObject font_texture_;
};

/// The Dear ImGui id of a GL texture.
inline void* uiTexture(GLuint id) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): it is never dereferenced
  return reinterpret_cast<void*>(static_cast<std::uintptr_t>(id));
}

}  // namespace broadmark
