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
  float haze[3]{};               ///< 0 to 1
  std::uint32_t background = 0;  ///< RGBA8, in memory order
};

/// The pixels that a box may cover, borders included; none if left > right.
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

/// Some rows of the picture, while boxes are drawn into them.
struct SplatBand {
  int begin = 0;  ///< rows [begin, end)
  int end = 0;
  int stride = 0;                  ///< pixels from row to row: width + kSplatPadding
  float* depths = nullptr;         ///< along the view axis
  std::uint32_t* boxes = nullptr;  ///< which box is foremost
};

struct SplatKernels {
  /// Fills rectangles[i] for the boxes [begin, end).
  void (*project)(const SplatView& view, const SplatBox* boxes, std::size_t begin, std::size_t end,
                  PixelRectangle* rectangles);
  /// Draws boxes, given by their positions, into a band. Of equally near boxes the first wins.
  void (*splat)(const SplatView& view, const SplatBox* boxes, const PixelRectangle* rectangles,
                const std::uint32_t* which, std::size_t count, const SplatBand& band);
  /// Writes colours (RGBA8) and window depths (0 to 1) of a band's pixels; rows of `view.width`.
  void (*shade)(const SplatView& view, const SplatBox* boxes, const SplatBand& band,
                std::uint32_t* colours, float* depths);
};

/// The best kernels that `isa` allows, which this processor must support.
const SplatKernels& splatKernels(Isa isa);

}  // namespace broadmark
