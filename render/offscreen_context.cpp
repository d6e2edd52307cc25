// EGL without a display, and OSMesa. EGL is tried in this order: each device (hardware before
// software), Mesa's surfaceless platform, the default display.
#include "broadmark/render/offscreen_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "broadmark/render/gl.h"

namespace broadmark {
namespace {

/// A library opened at run time. It is never unloaded, because GL drivers start threads and
/// register exit handlers, and crash when unloaded.
class SharedLibrary {
 public:
  /// Throws RenderError.
  explicit SharedLibrary(const std::string& name)
      : name_(name), handle_(dlopen(name.c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE)) {
    if (handle_ == nullptr) throw RenderError(name + " not found");
  }

  /// Throws RenderError if the library does not have the function.
  template <class Function>
  Function get(const char* function) const {
    void* address = dlsym(handle_, function);
    if (address == nullptr) throw RenderError(name_ + " lacks " + function);
    return reinterpret_cast<Function>(address);
  }

 private:
  std::string name_;
  void* handle_;
};

/// The EGL functions in use.
struct EglFunctions {
  explicit EglFunctions(const SharedLibrary& library)
      : getError(library.get<decltype(getError)>("eglGetError")),
        getProcAddress(library.get<decltype(getProcAddress)>("eglGetProcAddress")),
        getDisplay(library.get<decltype(getDisplay)>("eglGetDisplay")),
        initialize(library.get<decltype(initialize)>("eglInitialize")),
        queryString(library.get<decltype(queryString)>("eglQueryString")),
        bindApi(library.get<decltype(bindApi)>("eglBindAPI")),
        chooseConfig(library.get<decltype(chooseConfig)>("eglChooseConfig")),
        createContext(library.get<decltype(createContext)>("eglCreateContext")),
        destroyContext(library.get<decltype(destroyContext)>("eglDestroyContext")),
        createPbuffer(library.get<decltype(createPbuffer)>("eglCreatePbufferSurface")),
        destroySurface(library.get<decltype(destroySurface)>("eglDestroySurface")),
        makeCurrent(library.get<decltype(makeCurrent)>("eglMakeCurrent")) {}

  // NOLINTBEGIN(readability-identifier-naming): named like functions
  decltype(&eglGetError) getError;
  decltype(&eglGetProcAddress) getProcAddress;
  decltype(&eglGetDisplay) getDisplay;
  decltype(&eglInitialize) initialize;
  decltype(&eglQueryString) queryString;
  decltype(&eglBindAPI) bindApi;
  decltype(&eglChooseConfig) chooseConfig;
  decltype(&eglCreateContext) createContext;
  decltype(&eglDestroyContext) destroyContext;
  decltype(&eglCreatePbufferSurface) createPbuffer;
  decltype(&eglDestroySurface) destroySurface;
  decltype(&eglMakeCurrent) makeCurrent;
  // NOLINTEND(readability-identifier-naming)

  /// An extension's function, or null.
  template <class Function>
  Function extension(const char* name) const {
    return reinterpret_cast<Function>(getProcAddress(name));
  }

  [[noreturn]] void fail(const char* function) const {
    throw RenderError(fmt::format("{} failed (EGL error {:#06x})", function, getError()));
  }
};

/// A source of a display.
struct DisplaySource {
  std::string name;
  EGLenum platform = EGL_NONE;  ///< none: the default display
  void* native = EGL_DEFAULT_DISPLAY;
};

/// Whether a space-separated list (null: empty) contains this extension.
bool hasExtension(const char* list, std::string_view extension) {
  return list != nullptr &&
         fmt::format(" {} ", list).find(fmt::format(" {} ", extension)) != std::string::npos;
}

std::vector<DisplaySource> devices(const EglFunctions& egl, bool software_only) {
  const auto query = egl.extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto describe = egl.extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  std::array<EGLDeviceEXT, 64> handles{};
  EGLint count = 0;
  if (query == nullptr || describe == nullptr ||
      !query(static_cast<EGLint>(handles.size()), handles.data(), &count)) {
    return {};
  }

  std::vector<DisplaySource> hardware;
  std::vector<DisplaySource> software;
  for (EGLint i = 0; i < count; ++i) {
    const DisplaySource source{fmt::format("device {}", i), EGL_PLATFORM_DEVICE_EXT, handles[i]};
    const char* extensions = describe(handles[i], EGL_EXTENSIONS);
    const bool is_software = hasExtension(extensions, "EGL_MESA_device_software");
    (is_software ? software : hardware).push_back(source);
  }
  if (software_only) return software;
  hardware.insert(hardware.end(), software.begin(), software.end());
  return hardware;
}

std::vector<DisplaySource> displaySources(const EglFunctions& egl, bool software_only) {
  std::vector<DisplaySource> sources = devices(egl, software_only);
  sources.push_back({"surfaceless platform", EGL_PLATFORM_SURFACELESS_MESA});
  sources.push_back({"default display"});
  return sources;
}

/// A context on a display. The display is never terminated, because all contexts of the process on
/// the same device share it.
class Egl final : public OffscreenContext {
 public:
  Egl(const EglFunctions& egl, const DisplaySource& source) : egl_(egl), name_(source.name) {
    openDisplay(source);
    try {
      createContext();
    } catch (...) {
      close();
      throw;
    }
  }
  ~Egl() override { close(); }

  [[nodiscard]] std::string description() const override {
    return fmt::format("EGL {}, {}", name_, describeGl(*this));
  }
  [[nodiscard]] void* function(const char* name) const override {
    return egl_.extension<void*>(name);
  }

 private:
  void openDisplay(const DisplaySource& source) {
    if (source.platform == EGL_NONE) {
      display_ = egl_.getDisplay(EGL_DEFAULT_DISPLAY);
    } else {
      const auto get = egl_.extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
      if (get == nullptr) throw RenderError("no eglGetPlatformDisplayEXT");
      display_ = get(source.platform, source.native, nullptr);
    }
    if (display_ == EGL_NO_DISPLAY) egl_.fail("eglGetDisplay");
    if (!egl_.initialize(display_, nullptr, nullptr)) egl_.fail("eglInitialize");
  }

  void createContext() {
    if (!egl_.bindApi(EGL_OPENGL_API)) egl_.fail("eglBindAPI");
    const char* extensions = egl_.queryString(display_, EGL_EXTENSIONS);
    EGLConfig config = EGL_NO_CONFIG_KHR;
    if (!hasExtension(extensions, "EGL_KHR_no_config_context") ||
        !hasExtension(extensions, "EGL_KHR_surfaceless_context")) {
      config = pbufferConfig();
      const std::array size = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
      surface_ = egl_.createPbuffer(display_, config, size.data());
      if (surface_ == EGL_NO_SURFACE) egl_.fail("eglCreatePbufferSurface");
    }
    const std::array attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                   3,
                                   EGL_CONTEXT_MINOR_VERSION,
                                   3,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                   EGL_NONE};
    context_ = egl_.createContext(display_, config, EGL_NO_CONTEXT, attributes.data());
    if (context_ == EGL_NO_CONTEXT) egl_.fail("eglCreateContext for OpenGL 3.3 core");
    if (!egl_.makeCurrent(display_, surface_, surface_, context_)) egl_.fail("eglMakeCurrent");
  }

  [[nodiscard]] EGLConfig pbufferConfig() const {
    const std::array attributes = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                   EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!egl_.chooseConfig(display_, attributes.data(), &config, 1, &count) || count == 0) {
      egl_.fail("eglChooseConfig");
    }
    return config;
  }

  void close() {
    egl_.makeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (surface_ != EGL_NO_SURFACE) egl_.destroySurface(display_, surface_);
    if (context_ != EGL_NO_CONTEXT) egl_.destroyContext(display_, context_);
  }

  EglFunctions egl_;
  std::string name_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLSurface surface_ = EGL_NO_SURFACE;
  EGLContext context_ = EGL_NO_CONTEXT;
};

// From GL/osmesa.h, to avoid a dependency on libosmesa6-dev.
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

/// Mesa's software rasteriser as a plain library, which works without an EGL driver.
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
    if (context_ == nullptr) {
      throw RenderError("OSMesaCreateContextAttribs did not create an OpenGL 3.3 context");
    }
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
  // OSMesa requires a buffer, although drawing uses a framebuffer object.
  std::array<std::uint8_t, std::size_t{4} * kSide * kSide> buffer_{};
};

std::unique_ptr<OffscreenContext> makeEglContext(const OffscreenOptions& options) {
  const EglFunctions egl{SharedLibrary(options.egl_library)};
  std::string failures;
  for (const DisplaySource& source : displaySources(egl, options.software)) {
    try {
      return std::make_unique<Egl>(egl, source);
    } catch (const RenderError& error) {
      failures += fmt::format("{}{}: {}", failures.empty() ? "" : ", ", source.name, error.what());
    }
  }
  throw RenderError(failures);
}

std::unique_ptr<OffscreenContext> makeOsmesaContext(const OffscreenOptions& options) {
  return std::make_unique<Osmesa>(options.osmesa_library);
}

}  // namespace

std::unique_ptr<OffscreenContext> makeOffscreenContext(GlSource source,
                                                       const OffscreenOptions& options) {
  std::string failures;
  const auto attempt = [&](GlSource which, const char* name, auto make) {
    if (source != GlSource::automatic && source != which) {
      return std::unique_ptr<OffscreenContext>();
    }
    try {
      return make(options);
    } catch (const RenderError& error) {
      failures += (failures.empty() ? "" : "; ") + std::string(name) + ": " + error.what();
      return std::unique_ptr<OffscreenContext>();
    }
  };
  if (auto context = attempt(GlSource::egl, "EGL", makeEglContext)) return context;
  if (auto context = attempt(GlSource::osmesa, "OSMesa", makeOsmesaContext)) return context;
  throw RenderError("no OpenGL 3.3 for off-screen pictures: " + failures);
}

std::unique_ptr<OffscreenContext> makeOffscreenContext(GlSource source) {
  return makeOffscreenContext(source, OffscreenOptions{});
}

}  // namespace broadmark
