// The inner loops of the software renderer, as one table of functions per instruction set. All give
// the same picture, bit for bit.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/execution.h"

namespace broadmark {

/// A box in view space, laid out like a Primitive. Plain arrays: the kernels must not call
/// functions of standard headers.
struct SplatBox {
  float low[3]{};
  float colour = 0;  ///< 0xRRGGBB as a number
  float high[3]{};
  float width = 0;  ///< the least width it is drawn with, in pixels
};

/// A line in view space, laid out like a Primitive.
struct SplatLine {
  float from[3]{};
  float colour = 0;  ///< 0xRRGGBB as a number
  float to[3]{};
  float width = 0;  ///< pixels
};

/// A line in the picture. In pixels, but for the depths in the window.
struct SplatStrip {
  float start[2]{};
  float direction[2]{};  ///< of length 1
  float length = 0;
  float half_width = 0;
  float depth = 0;       ///< at the start
  float depth_step = 0;  ///< by pixel of length
};

/// A viewpoint as the kernels need it. Points are relative to the eye; pixel columns run from left
/// to right, rows from bottom to top as in OpenGL.
struct SplatView {
  int width = 0;
  int height = 0;
  float eye[3]{};
  float forward[3]{};  ///< dot(forward, p) is the depth of p
  float column[3]{};   ///< dot(column, p) / depth: pixels from the left border
  float row[3]{};      ///< dot(row, p) / depth: pixels from the lower border
  /// The direction through (x, y) in pixels, of depth 1: corner + x step_x + y step_y.
  float corner[3]{};
  float step_x[3]{};
  float step_y[3]{};
  float near = 0;
  float far = 0;
  float pixel = 0;  ///< length that a pixel covers at depth 1
  float edge_pixels = 0;
  float haze_begin = 0;  ///< depth
  float haze_end = 0;
  float haze[3]{};  ///< 0 to 1
};

/// The pixels that a box or a line may cover, borders included; none if left > right.
struct PixelRectangle {
  std::int16_t left = 0;
  std::int16_t right = -1;
  std::int16_t bottom = 0;
  std::int16_t top = -1;
};

/// Kernels may write this many pixels behind the end of a row.
inline constexpr int kSplatPadding = 8;
/// Stands for the box in a pixel that no box covers.
inline constexpr std::uint32_t kNoBox = 0xFFFFFFFF;

/// Some rows of the picture, while they are drawn.
struct SplatBand {
  int begin = 0;  ///< rows [begin, end)
  int end = 0;
  int stride = 0;  ///< pixels from row to row: width + kSplatPadding
  /// Of boxes that are being drawn, along the view axis; after shading in the window, 0 to 1.
  float* depths = nullptr;
  std::uint32_t* boxes = nullptr;    ///< which box is foremost
  std::uint32_t* colours = nullptr;  ///< RGBA8, in memory order
};

/// Which parts of lines to draw.
struct LinePass {
  bool behind = false;  ///< those behind the boxes, else those before them
  float opacity = 1;
};

struct SplatKernels {
  /// Fills rectangles[i] for the boxes [begin, end).
  void (*project_boxes)(const SplatView& view, const SplatBox* boxes, std::size_t begin,
                        std::size_t end, PixelRectangle* rectangles);
  /// Draws boxes, given by their positions, into a band: depths, and which is foremost. Of equally
  /// near boxes the first wins.
  void (*splat_boxes)(const SplatView& view, const SplatBox* boxes,
                      const PixelRectangle* rectangles, const std::uint32_t* which,
                      std::size_t count, const SplatBand& band);
  /// Colours the pixels that boxes cover, and turns the band's depths into those of the window, 1
  /// where there is no box.
  void (*shade_boxes)(const SplatView& view, const SplatBox* boxes, const SplatBand& band);
  /// Fills strips[i] and rectangles[i] for the lines [begin, end). `at_far_end`: their depth in the
  /// window is 1.
  void (*project_lines)(const SplatView& view, const SplatLine* lines, std::size_t begin,
                        std::size_t end, bool at_far_end, SplatStrip* strips,
                        PixelRectangle* rectangles);
  /// Blends lines, given by their positions, into the colours of a band that is shaded.
  void (*draw_lines)(const SplatLine* lines, const SplatStrip* strips,
                     const PixelRectangle* rectangles, const std::uint32_t* which,
                     std::size_t count, const LinePass& pass, const SplatBand& band);
};

/// The best kernels that `isa` allows, which this processor must support.
const SplatKernels& splatKernels(Isa isa);

}  // namespace broadmark
