// Pictures: drawing a frame off-screen, PNG files.
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

/// There is no OpenGL, or it failed. The message is one line: what was tried and why it failed.
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

/// Where an off-screen OpenGL 3.3 core context comes from. `automatic` tries EGL, then OSMesa.
enum class GlSource { automatic, egl, osmesa };

/// An off-screen context, current on the thread that made it; at most one lives per thread.
class OffscreenContext {
 public:
  virtual ~OffscreenContext() = default;
  /// "EGL device 0, llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5"
  [[nodiscard]] virtual std::string description() const = 0;
  /// Address of a GL function, or null.
  [[nodiscard]] virtual void* function(const char* name) const = 0;
};

/// Throws RenderError naming every source that was tried and why each failed.
std::unique_ptr<OffscreenContext> makeOffscreenContext(GlSource);

inline constexpr int kLargestPicture = 16384;  ///< pixels, either side

/// Draws one frame: all boxes, those in a pair of `overlaps` in a colour of their own, the world
/// and its floor, seen by figureCamera(). Throws RenderError.
Picture drawFrame(OffscreenContext&, const SceneInfo&, const Frame&, PairRuns overlaps, int width,
                  int height);

/// Writes a PNG, whole or not at all. Throws InputError if the path cannot be written.
void writePng(const std::filesystem::path&, const Picture&);

/// Reads a PNG. Throws InputError.
Picture readPng(const std::filesystem::path&);

}  // namespace broadmark
