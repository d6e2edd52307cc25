// The OpenGL 3.3 functions that are used here, in one table, filled through whatever made the
// context (EGL, OSMesa, GLFW). Loader libraries do not cope with all three.
#pragma once

#include <GL/glcorearb.h>

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "broadmark/render/picture.h"

namespace broadmark {

// clang-format off
#define BROADMARK_GL_FUNCTIONS(X)                                                              \
  X(ATTACHSHADER, AttachShader) X(BINDBUFFER, BindBuffer)                                      \
  X(BINDFRAMEBUFFER, BindFramebuffer) X(BINDRENDERBUFFER, BindRenderbuffer)                    \
  X(BINDTEXTURE, BindTexture) X(BINDVERTEXARRAY, BindVertexArray) X(BLENDFUNC, BlendFunc)      \
  X(BLITFRAMEBUFFER, BlitFramebuffer) X(BUFFERDATA, BufferData)                                \
  X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus) X(CLEAR, Clear)                            \
  X(CLEARCOLOR, ClearColor) X(COMPILESHADER, CompileShader) X(CREATEPROGRAM, CreateProgram)    \
  X(CREATESHADER, CreateShader) X(DELETEBUFFERS, DeleteBuffers)                                \
  X(DELETEFRAMEBUFFERS, DeleteFramebuffers) X(DELETEPROGRAM, DeleteProgram)                    \
  X(DELETERENDERBUFFERS, DeleteRenderbuffers) X(DELETESHADER, DeleteShader)                    \
  X(DELETETEXTURES, DeleteTextures) X(DELETEVERTEXARRAYS, DeleteVertexArrays)                  \
  X(DEPTHMASK, DepthMask) X(DEPTHFUNC, DepthFunc) X(DISABLE, Disable)                          \
  X(DRAWARRAYS, DrawArrays) X(ENABLE, Enable)                                                  \
  X(FRAMEBUFFERRENDERBUFFER, FramebufferRenderbuffer) X(GENBUFFERS, GenBuffers)                \
  X(GENFRAMEBUFFERS, GenFramebuffers) X(GENRENDERBUFFERS, GenRenderbuffers)                    \
  X(GENTEXTURES, GenTextures) X(GENVERTEXARRAYS, GenVertexArrays) X(GETERROR, GetError)        \
  X(GETINTEGERV, GetIntegerv) X(GETPROGRAMINFOLOG, GetProgramInfoLog)                          \
  X(GETPROGRAMIV, GetProgramiv) X(GETSHADERINFOLOG, GetShaderInfoLog)                          \
  X(GETSHADERIV, GetShaderiv) X(GETSTRING, GetString)                                          \
  X(GETUNIFORMLOCATION, GetUniformLocation) X(LINKPROGRAM, LinkProgram)                        \
  X(PIXELSTOREI, PixelStorei) X(READPIXELS, ReadPixels)                                        \
  X(RENDERBUFFERSTORAGEMULTISAMPLE, RenderbufferStorageMultisample)                            \
  X(SHADERSOURCE, ShaderSource) X(TEXBUFFER, TexBuffer) X(UNIFORM1F, Uniform1f)                \
  X(UNIFORM2F, Uniform2f) X(UNIFORM3F, Uniform3f) X(UNIFORMMATRIX4FV, UniformMatrix4fv)        \
  X(USEPROGRAM, UseProgram) X(VIEWPORT, Viewport)                                              \
  X(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray)                                          \
  X(VERTEXATTRIBPOINTER, VertexAttribPointer) X(DRAWELEMENTSBASEVERTEX, DrawElementsBaseVertex) \
  X(SCISSOR, Scissor) X(TEXIMAGE2D, TexImage2D) X(TEXPARAMETERI, TexParameteri)                \
  X(TEXSUBIMAGE2D, TexSubImage2D) X(FRAMEBUFFERTEXTURE2D, FramebufferTexture2D)                \
  X(DEPTHRANGE, DepthRange) X(FINISH, Finish) X(COLORMASK, ColorMask)
// clang-format on

/// Address of a GL function, or null.
using GlLoader = std::function<void*(const char* name)>;

/// The function table of one context.
struct Gl {
  /// Throws RenderError if a function is missing.
  explicit Gl(const GlLoader& load);
  explicit Gl(const OffscreenContext& context);

#define BROADMARK_GL_MEMBER(TYPE, name) PFNGL##TYPE##PROC name = nullptr;
  BROADMARK_GL_FUNCTIONS(BROADMARK_GL_MEMBER)
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

/// Makes one object of the kinds that GL creates and deletes in arrays:
/// makeObject(gl.GenBuffers, gl.DeleteBuffers).
template <class Generate, class DeleteArray>
GlObject makeObject(Generate generate, DeleteArray destroy) {
  GLuint id = 0;
  generate(1, &id);
  return {id, [destroy](GLuint old) { destroy(1, &old); }};
}

/// Compiles and links. Throws RenderError with the compiler's log.
GlObject makeProgram(const Gl& gl, std::string_view vertex_source,
                     std::string_view fragment_source);

}  // namespace broadmark
