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
  /// Value at frame k in [k]; NaN where there is none.
  std::vector<double> values;
  /// Frames that are marked as not to be trusted.
  std::vector<std::uint32_t> disturbed;
};

struct PlotOptions {
  bool logarithmic = false;
  /// Of the values, for axis and crosshair: 0.00125 s is shown as "1.25 ms".
  const char* unit = "s";
  double marked_frame = -1;  ///< a vertical line; below 0: none
  /// Shown range of frames.
  double first = 0;
  double last = 1;
  bool dark = true;
};

/// What the user did.
struct PlotResult {
  std::optional<double> clicked_frame;  ///< clicked at, or dragged to
  std::optional<std::size_t> toggled;   ///< curve whose legend entry was clicked
  std::optional<std::size_t> hovered;   ///< curve whose legend entry the mouse is over
  double zoom = 0;                      ///< turns of the wheel
  double zoom_at = 0;                   ///< the frame under the mouse then
};

/// Draws a plot that fills `width` x `height` pixels of the current Dear ImGui window: axes with
/// ticks at round values, curves (where several frames fall onto one pixel: the range between
/// lowest and highest), legend, crosshair with the values under the mouse.
PlotResult drawPlot(const char* id, const std::vector<PlotCurve>& curves,
                    const PlotOptions& options, float width, float height);

/// A number with an SI prefix and three significant digits: "1.25 ms".
std::string withPrefix(double value, const char* unit);

/// Round values for an axis from `low` to `high`: about `count` of them; powers of ten, with 2 and
/// 5 between them where there is room, on a logarithmic axis (`low` > 0).
std::vector<double> axisTicks(double low, double high, int count, bool logarithmic);

}  // namespace broadmark
