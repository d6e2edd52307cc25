// Pictures of a frame, drawn off-screen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/pair.h"

namespace broadmark {

/// No OpenGL to be had, or it failed: one line that says what was tried and why it failed.
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

/// Draws one frame: all boxes, those that are in a pair of `overlaps` in another colour, the world
/// box and the ground, seen from the figure camera of the paper. Throws RenderError.
Picture drawFrame(OffscreenContext&, const SceneInfo&, const Frame&, PairRuns overlaps, int width,
                  int height);

/// Writes a PNG atomically. Throws InputError if the path cannot be written.
void writePng(const std::filesystem::path&, const Picture&);

/// Reads a PNG. Throws InputError.
Picture readPng(const std::filesystem::path&);

}  // namespace broadmark
