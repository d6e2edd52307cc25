// Draws Dear ImGui's lists by our table of functions, in windows and off-screen alike. Dear ImGui's
// own OpenGL backend brings a loader that does not work with OSMesa.
#pragma once

#include "broadmark/render/gl.h"

struct ImDrawData;
struct ImDrawCmd;
struct ImFontAtlas;

namespace broadmark {

/// Needs its context current from construction to destruction. Textures are shown by their GL
/// names: ImGui::Image(uiTexture(id), …).
class UiRenderer {
 public:
  explicit UiRenderer(const Gl& gl);

  /// Makes a texture of the atlas. Call it again when its fonts have changed.
  void uploadFonts(ImFontAtlas& atlas);
  /// Draws over the whole of the current framebuffer.
  void draw(const ImDrawData& data);

 private:
  void drawCommand(const ImDrawCmd& command, const ImDrawData& data) const;

  const Gl* gl_;
  GlObject program_;
  GlObject vertex_array_;
  GlObject vertices_;
  GlObject indices_;
  GlObject font_texture_;
};

/// A GL texture as Dear ImGui names it.
inline void* uiTexture(GLuint id) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): it is never followed
  return reinterpret_cast<void*>(static_cast<std::uintptr_t>(id));
}

}  // namespace broadmark
