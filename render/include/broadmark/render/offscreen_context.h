// Creation of off-screen contexts. Most code only needs makeOffscreenContext(GlSource).
#pragma once

#include <memory>
#include <string>

#include "broadmark/render/picture.h"

namespace broadmark {

/// The libraries that create a context.
struct OffscreenOptions {
  std::string egl_library = "libEGL.so.1";
  std::string osmesa_library = "libOSMesa.so.8";
  bool software = false;  ///< without hardware devices: the same picture on every machine
};

/// Throws RenderError.
std::unique_ptr<OffscreenContext> makeOffscreenContext(GlSource, const OffscreenOptions&);

}  // namespace broadmark
