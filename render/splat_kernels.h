// The inner loops of the software renderer, as a table of functions per instruction set. All give
// bit-identical pictures.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/execution.h"

namespace broadmark {

/// A box in view space with the layout of Primitive. Uses plain arrays, because the kernels must
/// not call functions of standard headers.
struct SplatBox {
  float low[3]{};
  float colour = 0;  ///< 0xRRGGBB as a number
  float high[3]{};
  float width = 0;  ///< minimum width in pixels
};

/// A line in view space with the layout of Primitive.
struct SplatLine {
  float from[3]{};
  float colour = 0;  ///< 0xRRGGBB as a number
  float to[3]{};
  float width = 0;  ///< pixels
};

/// A line in the picture, in pixels and with window depths.
struct SplatStrip {
  float start[2]{};
  float direction[2]{};  ///< of length 1
  float length = 0;
  float half_width = 0;
  float depth = 0;       ///< at the start
  float depth_step = 0;  ///< per pixel of length
};

/// A viewpoint for the kernels. Points are relative to the eye; pixel columns are numbered from
/// left to right, rows from bottom to top as in OpenGL.
struct SplatView {
  int width = 0;
  int height = 0;
  float eye[3]{};
  float forward[3]{};  ///< dot(forward, p) is the depth of p
  float column[3]{};   ///< dot(column, p) / depth: pixels from the left border
  float row[3]{};      ///< dot(row, p) / depth: pixels from the lower border
  /// The direction through (x, y) in pixels with depth 1: corner + x step_x + y step_y.
  float corner[3]{};
  float step_x[3]{};
  float step_y[3]{};
  float near = 0;
  float far = 0;
  float pixel = 0;  ///< length of a pixel at depth 1
  float edge_pixels = 0;
  float haze_begin = 0;  ///< depth
  float haze_end = 0;
  float haze[3]{};  ///< 0 to 1
};

/// The pixels that a box or a line may cover, inclusive; empty if left > right.
struct PixelRectangle {
  std::int16_t left = 0;
  std::int16_t right = -1;
  std::int16_t bottom = 0;
  std::int16_t top = -1;
};

/// Kernels may write this number of pixels past the end of a row.
inline constexpr int kSplatPadding = 8;
/// The box index of a pixel without a box.
inline constexpr std::uint32_t kNoBox = 0xFFFFFFFF;

/// A band of rows of the picture.
struct SplatBand {
  int begin = 0;  ///< rows [begin, end)
  int end = 0;
  int stride = 0;  ///< pixels from row to row: width + kSplatPadding
  /// Depths along the view axis; after shading, window depths from 0 to 1.
  float* depths = nullptr;
  std::uint32_t* boxes = nullptr;    ///< the foremost box
  std::uint32_t* colours = nullptr;  ///< RGBA8, in memory order
};

/// The parts of lines to draw.
struct LinePass {
  bool behind = false;  ///< parts behind boxes, else parts in front of them
  float opacity = 1;
};

struct SplatKernels {
  /// Fills rectangles[i] for the boxes [begin, end).
  void (*project_boxes)(const SplatView& view, const SplatBox* boxes, std::size_t begin,
                        std::size_t end, PixelRectangle* rectangles);
  /// Draws boxes with these indices into a band: depths and foremost boxes. At equal depths the
  /// first box wins.
  void (*splat_boxes)(const SplatView& view, const SplatBox* boxes,
                      const PixelRectangle* rectangles, const std::uint32_t* which,
                      std::size_t count, const SplatBand& band);
  /// Shades the pixels covered by boxes, and converts the band's depths to window depths, 1 without
  /// a box.
  void (*shade_boxes)(const SplatView& view, const SplatBox* boxes, const SplatBand& band);
  /// Blends boxes with these indices into the colours of a shaded band, where they are in front of
  /// its depths.
  void (*blend_boxes)(const SplatView& view, const SplatBox* boxes,
                      const PixelRectangle* rectangles, const std::uint32_t* which,
                      std::size_t count, float opacity, const SplatBand& band);
  /// Fills strips[i] and rectangles[i] for the lines [begin, end). `at_far_end`: their window depth
  /// is 1.
  void (*project_lines)(const SplatView& view, const SplatLine* lines, std::size_t begin,
                        std::size_t end, bool at_far_end, SplatStrip* strips,
                        PixelRectangle* rectangles);
  /// Blends lines with these indices into the colours of a shaded band.
  void (*draw_lines)(const SplatLine* lines, const SplatStrip* strips,
                     const PixelRectangle* rectangles, const std::uint32_t* which,
                     std::size_t count, const LinePass& pass, const SplatBand& band);
};

/// The best kernels for `isa`, which the CPU must support.
const SplatKernels& splatKernels(Isa isa);

}  // namespace broadmark
