#include "broadmark/render/gl.h"

#include <fmt/format.h>

#include <array>

namespace broadmark {
namespace {

#if defined(__EMSCRIPTEN__)
constexpr std::string_view kShaderHeader =
    "#version 300 es\nprecision highp float;\nprecision highp sampler2D;\n";
#else
constexpr std::string_view kShaderHeader = "#version 330 core\n";
#endif

template <class GetParameter, class GetLog>
void checkBuilt(GLuint id, GLenum status, GetParameter parameter, GetLog get_log,
                std::string_view what) {
  GLint ok = 0;
  parameter(id, status, &ok);
  if (ok != 0) return;
  GLint length = 0;
  parameter(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length) + 1, '\0');
  GLsizei written = 0;
  get_log(id, static_cast<GLsizei>(log.size()), &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  throw RenderError(fmt::format("{} failed: {}", what, log));
}

GlObject makeShader(const Gl& gl, GLenum type, std::string_view source) {
  GlObject shader(gl.CreateShader(type), gl.DeleteShader);
  const std::array texts = {kShaderHeader.data(), source.data()};
  const std::array lengths = {static_cast<GLint>(kShaderHeader.size()),
                              static_cast<GLint>(source.size())};
  gl.ShaderSource(shader.get(), static_cast<GLsizei>(texts.size()), texts.data(), lengths.data());
  gl.CompileShader(shader.get());
  checkBuilt(
      shader.get(), GL_COMPILE_STATUS, gl.GetShaderiv, gl.GetShaderInfoLog,
      type == GL_VERTEX_SHADER ? "compiling a vertex shader" : "compiling a fragment shader");
  return shader;
}

}  // namespace

Gl::Gl(const GlLoader& load){
#define BROADMARK_GL_LOAD(name)                                \
  (name) = reinterpret_cast<decltype(name)>(load("gl" #name)); \
  if ((name) == nullptr) throw RenderError("OpenGL lacks gl" #name);
    BROADMARK_GL_FUNCTIONS(BROADMARK_GL_LOAD)
#undef BROADMARK_GL_LOAD
}

Gl::Gl(const OffscreenContext& context)
    : Gl([&context](const char* name) { return context.function(name); }) {
}

GLint Gl::integer(GLenum what) const {
  GLint value = 0;
  GetIntegerv(what, &value);
  return value;
}

void Gl::check(std::string_view doing) const {
  const GLenum error = GetError();
  if (error == GL_NO_ERROR) return;
  // Several errors may be pending; a lost context reports one on every call.
  for (int i = 0; i < 16 && GetError() != GL_NO_ERROR; ++i) {
  }
  const char* name = error == GL_OUT_OF_MEMORY                   ? "out of memory"
                     : error == GL_INVALID_VALUE                 ? "invalid value"
                     : error == GL_INVALID_OPERATION             ? "invalid operation"
                     : error == GL_INVALID_FRAMEBUFFER_OPERATION ? "invalid framebuffer operation"
                                                                 : "invalid enum";
  throw RenderError(fmt::format("OpenGL error {:#06x} ({}) while {}", error, name, doing));
}

std::string describeGl(const OffscreenContext& context) {
  const Gl gl(context);
  const auto text = [&gl](GLenum what) {
    const auto* string = reinterpret_cast<const char*>(gl.GetString(what));
    return string != nullptr ? string : "unknown";
  };
  return fmt::format("{}, OpenGL {}", text(GL_RENDERER), text(GL_VERSION));
}

GlObject makeProgram(const Gl& gl, std::string_view vertex_source,
                     std::string_view fragment_source) {
  const GlObject vertex = makeShader(gl, GL_VERTEX_SHADER, vertex_source);
  const GlObject fragment = makeShader(gl, GL_FRAGMENT_SHADER, fragment_source);
  GlObject program(gl.CreateProgram(), gl.DeleteProgram);
  gl.AttachShader(program.get(), vertex.get());
  gl.AttachShader(program.get(), fragment.get());
  gl.LinkProgram(program.get());
  checkBuilt(program.get(), GL_LINK_STATUS, gl.GetProgramiv, gl.GetProgramInfoLog,
             "linking a shader program");
  return program;
}

}  // namespace broadmark
