// A table of the functions in use, of OpenGL 3.3 and of WebGL 2. The library that created the
// context (EGL, OSMesa, GLFW) fills it, because no loader library works with all three.
#pragma once

#define GL_GLEXT_PROTOTYPES  // only for the types of the functions
#include <GL/glcorearb.h>

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "broadmark/render/picture.h"

namespace broadmark {

// clang-format off
#define BROADMARK_GL_FUNCTIONS(X)                                                                 \
  X(AttachShader) X(BindBuffer) X(BindFramebuffer) X(BindRenderbuffer) X(BindTexture)             \
  X(BindVertexArray) X(BlendFunc) X(BlitFramebuffer) X(BufferData) X(CheckFramebufferStatus)      \
  X(Clear) X(ClearColor) X(CompileShader) X(CreateProgram) X(CreateShader) X(DeleteBuffers)       \
  X(DeleteFramebuffers) X(DeleteProgram) X(DeleteRenderbuffers) X(DeleteShader) X(DeleteTextures) \
  X(DeleteVertexArrays) X(DepthMask) X(DepthFunc) X(Disable) X(DrawArrays) X(Enable)              \
  X(FramebufferRenderbuffer) X(GenBuffers) X(GenFramebuffers) X(GenRenderbuffers) X(GenTextures)  \
  X(GenVertexArrays) X(GetError) X(GetIntegerv) X(GetProgramInfoLog) X(GetProgramiv)              \
  X(GetShaderInfoLog) X(GetShaderiv) X(GetString) X(GetUniformLocation) X(LinkProgram)            \
  X(PixelStorei) X(ReadPixels) X(RenderbufferStorageMultisample) X(ShaderSource)                  \
  X(Uniform1f) X(Uniform2f) X(Uniform3f) X(UniformMatrix4fv) X(UseProgram) X(Viewport)            \
  X(EnableVertexAttribArray) X(VertexAttribPointer) X(DrawElements) X(Scissor)                    \
  X(TexImage2D) X(TexParameteri) X(TexSubImage2D) X(FramebufferTexture2D) X(DepthRange) X(Finish) \
  X(ColorMask)
// clang-format on

/// Address of a GL function, or null.
using GlLoader = std::function<void*(const char* name)>;

/// The function table of a context.
struct Gl {
  /// Throws RenderError if a function is missing.
  explicit Gl(const GlLoader& load);
  explicit Gl(const OffscreenContext& context);

#define BROADMARK_GL_MEMBER(name) \
  decltype(&::gl##name) name = nullptr;        // NOLINT(bugprone-macro-parentheses): a name
  BROADMARK_GL_FUNCTIONS(BROADMARK_GL_MEMBER)  // NOLINT(readability-identifier-naming): GL's names
#undef BROADMARK_GL_MEMBER

  [[nodiscard]] GLint integer(GLenum what) const;
  /// Throws RenderError if an error is pending; `doing` completes "OpenGL error … while …".
  void check(std::string_view doing) const;
};

/// "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5 …"
std::string describeGl(const OffscreenContext& context);

/// Owns a GL object: an id and the function that deletes it.
class GlObject {
 public:
  using Delete = std::function<void(GLuint)>;
  GlObject() = default;
  GlObject(GLuint id, Delete destroy) : id_(id), destroy_(std::move(destroy)) {}
  GlObject(GlObject&& other) noexcept { swap(other); }
  GlObject& operator=(GlObject&& other) noexcept {
    swap(other);
    return *this;
  }
  ~GlObject() {
    if (id_ != 0) destroy_(id_);
  }
  [[nodiscard]] GLuint get() const { return id_; }

 private:
  void swap(GlObject& other) noexcept {
    std::swap(id_, other.id_);
    destroy_.swap(other.destroy_);
  }
  GLuint id_ = 0;
  Delete destroy_;
};

/// Creates an object with GL's functions for arrays of objects: makeObject(gl.GenBuffers,
/// gl.DeleteBuffers).
template <class Generate, class DeleteArray>
GlObject makeObject(Generate generate, DeleteArray destroy) {
  GLuint id = 0;
  generate(1, &id);
  return {id, [destroy](GLuint old) { destroy(1, &old); }};
}

/// Compiles and links a program. Throws RenderError with the compiler's log.
GlObject makeProgram(const Gl& gl, std::string_view vertex_source,
                     std::string_view fragment_source);

}  // namespace broadmark
