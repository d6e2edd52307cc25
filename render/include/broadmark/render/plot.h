// A plot of several curves over frames, for the user interface.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/render/colour.h"
#include "broadmark/render/frame_values.h"
#include "broadmark/render/plot_canvas.h"

namespace broadmark {

/// The values are not owned.
struct PlotCurve {
  std::string label;
  Rgb colour = 0;
  const FrameValues* values = nullptr;
  /// Frames with a known number here are circled; may be null.
  const FrameValues* circled = nullptr;
  bool hidden = false;
};

/// A row of marks above the curves, at every known frame in any of `frames`, even if several share
/// a pixel.
struct PlotMarks {
  std::string label;  ///< of a marked frame: "wrong"
  Rgb colour = 0;
  std::vector<const FrameValues*> frames;  ///< not owned
};

struct PlotOptions {
  bool logarithmic = false;
  /// Unit of the values on axis and crosshair: 0.00125 s appears as "1.25 ms".
  const char* unit = "s";
  /// The visible frames.
  double first = 0;
  double last = 1;
  std::uint32_t playhead = 0;  ///< the current frame; an arrow points to it if invisible
  double limit = 0;            ///< a horizontal line with its value, or 0
  Rgb limit_colour = 0;
  /// The shaded frames, inclusive.
  std::optional<std::array<double, 2>> span;
  /// An area behind the curves, on a separate scale from 0 without a unit, or null.
  const PlotCurve* area = nullptr;
  /// A thin line on a separate scale at the right without a unit, or null.
  const PlotCurve* thin = nullptr;
  std::vector<PlotMarks> marks;
  /// The sum of the curves, which are then stacked, without a legend; or null. If several frames
  /// share a pixel, the one with the maximum is drawn, and a click selects it.
  const FrameValues* stack_total = nullptr;
  double least_top = 0;                      ///< the scale of a stack reaches at least this value
  std::string title;                         ///< in the upper left corner
  bool frame_numbers = true;                 ///< below the axes
  std::vector<PlotShape>* shapes = nullptr;  ///< see PlotCanvas
};

/// The user's input.
struct PlotResult {
  /// The clicked frame, the marked frame of a clicked mark, or the frame of a drag along the frame
  /// numbers.
  std::optional<double> clicked_frame;
  std::optional<std::array<double, 2>> dragged;  ///< over the curves: from and to frame
  std::optional<std::size_t> toggled;            ///< curve of the clicked legend entry
  std::optional<std::size_t> hovered;            ///< curve of the legend entry under the mouse
  double moved = 0;                              ///< number of frames dragged with another button
  double zoom = 0;                               ///< turns of the wheel
  double zoom_at = 0;                            ///< the frame under the mouse during the zoom
};

/// Draws a plot of `width` x `height` pixels into the current Dear ImGui window, in the colours of
/// its style: axes with ticks at round values, curves, legend, a crosshair with the values under
/// the mouse. If several frames share a pixel, a curve shows the range of their values. The time is
/// independent of the number of frames.
PlotResult drawPlot(const char* id, const std::vector<PlotCurve>& curves,
                    const PlotOptions& options, float width, float height);

/// The level at which a pixel has one to two blocks of 2^level frames.
unsigned plotLevel(double frames_per_pixel);

/// A number with an SI prefix and three significant digits: "1.25 ms". Without a unit, up to four
/// digits are exact: "1234", "5k", "12.3k", "1.5M".
std::string withPrefix(double value, const char* unit);

/// About `count` round values for an axis from `low` to `high`. On a logarithmic axis (`low` > 0):
/// powers of ten, and 2 and 5 times these if there is space.
std::vector<double> axisTicks(double low, double high, int count, bool logarithmic);

}  // namespace broadmark
