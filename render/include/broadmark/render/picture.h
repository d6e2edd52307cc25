// Drawing a frame off-screen, and PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/pair.h"

namespace broadmark {

/// OpenGL is missing or failed. The message is one line with the attempts and the reasons.
class RenderError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// 8-bit RGBA, rows from top to bottom.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;
};

/// The source of an off-screen OpenGL 3.3 core context. `automatic` tries EGL, then OSMesa.
enum class GlSource { automatic, egl, osmesa };

/// An off-screen context, current on the thread that created it; at most one exists per thread.
class OffscreenContext {
 public:
  virtual ~OffscreenContext() = default;
  /// "EGL device 0, llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5"
  [[nodiscard]] virtual std::string description() const = 0;
  /// Address of a GL function, or null.
  [[nodiscard]] virtual void* function(const char* name) const = 0;
};

/// Throws RenderError with the failed sources and the reasons.
std::unique_ptr<OffscreenContext> makeOffscreenContext(GlSource);

inline constexpr int kMaxPictureSide = 16384;  ///< pixels per side

/// Draws a frame with figureCamera(): all boxes, with a separate colour for bodies in `overlaps`,
/// the world and its floor. Throws RenderError.
Picture drawFrame(OffscreenContext&, const SceneInfo&, const Frame&, PairRuns overlaps, int width,
                  int height);

/// The bytes of a PNG file. Throws InputError for an empty picture.
std::string encodePng(const Picture&);
/// Writes a PNG atomically. Throws InputError if the path cannot be written.
void writePng(const std::filesystem::path&, const Picture&);

/// Reads a PNG. Throws InputError.
Picture readPng(const std::filesystem::path&);

}  // namespace broadmark
