// How an off-screen context is found; the public face is makeOffscreenContext(GlSource).
#pragma once

#include <memory>
#include <string>

#include "broadmark/render/picture.h"

namespace broadmark {

/// What a context is made from.
struct OffscreenOptions {
  std::string egl_library = "libEGL.so.1";
  std::string osmesa_library = "libOSMesa.so.8";
  bool software = false;  ///< skip hardware devices: the same picture on every machine
};

std::unique_ptr<OffscreenContext> makeOffscreenContext(GlSource, const OffscreenOptions&);

// The single sources. Both throw RenderError.
std::unique_ptr<OffscreenContext> makeEglContext(const OffscreenOptions&);
std::unique_ptr<OffscreenContext> makeOsmesaContext(const OffscreenOptions&);

}  // namespace broadmark
