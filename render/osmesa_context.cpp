// OSMesa: Mesa's software rasteriser as a plain library. Works where EGL has no driver.
#include <fmt/format.h>

#include <array>

#include "broadmark/render/gl.h"
#include "broadmark/render/offscreen_context.h"
#include "shared_library.h"

namespace broadmark {
namespace {

// From GL/osmesa.h: not worth a dependency on libosmesa6-dev.
using OSMesaContext = struct osmesa_context*;
using Proc = void (*)();
using MakeCurrent = unsigned char (*)(OSMesaContext, void*, GLenum, GLsizei, GLsizei);
enum Attribute : int {
  kFormat = 0x22,
  kDepthBits = 0x30,
  kProfile = 0x33,
  kCoreProfile = 0x34,
  kMajorVersion = 0x36,
  kMinorVersion = 0x37,
};

class Osmesa final : public OffscreenContext {
 public:
  explicit Osmesa(const std::string& library_name)
      : library_(library_name),
        make_current_(library_.get<MakeCurrent>("OSMesaMakeCurrent")),
        destroy_(library_.get<void (*)(OSMesaContext)>("OSMesaDestroyContext")),
        address_(library_.get<Proc (*)(const char*)>("OSMesaGetProcAddress")) {
    const auto create =
        library_.get<OSMesaContext (*)(const int*, OSMesaContext)>("OSMesaCreateContextAttribs");
    const int attributes[] = {kFormat,       GL_RGBA, kDepthBits,    24, kProfile, kCoreProfile,
                              kMajorVersion, 3,       kMinorVersion, 3,  0};
    context_ = create(attributes, nullptr);
    if (context_ == nullptr) throw RenderError("OSMesaCreateContextAttribs gave no 3.3 context");
    if (make_current_(context_, buffer_.data(), GL_UNSIGNED_BYTE, kSide, kSide) == 0) {
      destroy_(context_);
      throw RenderError("OSMesaMakeCurrent failed");
    }
  }
  ~Osmesa() override {
    make_current_(nullptr, nullptr, 0, 0, 0);
    destroy_(context_);
  }

  [[nodiscard]] std::string description() const override {
    return fmt::format("OSMesa, {}", describeGl(*this));
  }
  [[nodiscard]] void* function(const char* name) const override {
    return reinterpret_cast<void*>(address_(name));
  }

 private:
  static constexpr int kSide = 16;

  SharedLibrary library_;
  MakeCurrent make_current_;
  void (*destroy_)(OSMesaContext);
  Proc (*address_)(const char*);
  OSMesaContext context_ = nullptr;
  // OSMesa wants a buffer of its own; we draw into a framebuffer object.
  std::array<std::uint8_t, std::size_t{4} * kSide * kSide> buffer_{};
};

}  // namespace

std::unique_ptr<OffscreenContext> makeOsmesaContext(const OffscreenOptions& options) {
  return std::make_unique<Osmesa>(options.osmesa_library);
}

}  // namespace broadmark
