#include "broadmark/render/offscreen_context.h"

namespace broadmark {

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
