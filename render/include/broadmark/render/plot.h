// A plot of several curves over frames, for the user interface.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/debug_draw.h"

namespace broadmark {

struct PlotCurve {
  std::string label;
  Rgb colour = 0;
  bool hidden = false;
  /// values[k] belongs to frame k; NaN if it has none.
  std::vector<double> values;
  /// Frames whose values are marked: something disturbed the measurement.
  std::vector<std::uint32_t> disturbed;
};

struct PlotOptions {
  bool logarithmic = false;
  /// Unit of the values on axis and crosshair: 0.00125 s is shown as "1.25 ms".
  const char* unit = "s";
  double marked_frame = -1;  ///< a vertical line; below 0: none
  /// The frames shown.
  double first = 0;
  double last = 1;
  bool dark = true;
  double limit = 0;  ///< a horizontal line with its value; 0: none
  /// Drawn behind the curves, from 0 on a scale of its own, without a unit; null: nothing.
  const PlotCurve* backdrop = nullptr;
};

/// What the user did.
struct PlotResult {
  std::optional<double> clicked_frame;  ///< clicked, or dragged to
  std::optional<std::size_t> toggled;   ///< curve whose legend entry was clicked
  std::optional<std::size_t> hovered;   ///< curve whose legend entry the mouse is over
  double zoom = 0;                      ///< turns of the wheel
  double zoom_at = 0;                   ///< the frame under the mouse then
};

/// Draws a plot of `width` x `height` pixels into the current Dear ImGui window: axes with ticks at
/// round values, curves, legend, a crosshair with the values under the mouse. Where several frames
/// fall onto one pixel, a curve shows the range from the lowest to the highest value.
PlotResult drawPlot(const char* id, const std::vector<PlotCurve>& curves,
                    const PlotOptions& options, float width, float height);

/// A number with an SI prefix and three significant digits: "1.25 ms".
std::string withPrefix(double value, const char* unit);

/// About `count` round values for an axis from `low` to `high`. On a logarithmic axis (`low` > 0):
/// powers of ten, with 2 and 5 times these where there is room.
std::vector<double> axisTicks(double low, double high, int count, bool logarithmic);

}  // namespace broadmark
