// A plot of several curves over frames, for the user interface.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/render/colour.h"
#include "broadmark/render/frame_values.h"

namespace broadmark {

/// What it is made of is borrowed for a call.
struct PlotCurve {
  std::string label;
  Rgb colour = 0;
  const FrameValues* values = nullptr;
  /// Values of the frames that are known here are circled; null: of none.
  const FrameValues* circled = nullptr;
  bool hidden = false;
};

/// A row of marks above the curves: at every frame known in any of `frames`, however many fall onto
/// one pixel.
struct PlotMarks {
  std::string label;  ///< of such a frame: "wrong"
  Rgb colour = 0;
  std::vector<const FrameValues*> frames;  ///< borrowed
};

struct PlotOptions {
  bool logarithmic = false;
  /// Unit of the values on axis and crosshair: 0.00125 s is shown as "1.25 ms".
  const char* unit = "s";
  /// The frames shown.
  double first = 0;
  double last = 1;
  std::uint32_t playhead = 0;  ///< the present frame, pointed to when it is not among these
  double limit = 0;            ///< a horizontal line with its value; 0: none
  Rgb limit_colour = 0;
  /// Frames that are shaded, both included.
  std::optional<std::array<double, 2>> span;
  /// Drawn behind the curves, from 0 on a scale of its own, without a unit; null: nothing.
  const PlotCurve* area = nullptr;
  /// Likewise, as a thin line whose scale stands at the right.
  const PlotCurve* thin = nullptr;
  std::vector<PlotMarks> marks;
};

/// What the user did.
struct PlotResult {
  /// The frame that was clicked, of marks the one that is marked; or dragged to, along the numbers
  /// of the frames.
  std::optional<double> clicked_frame;
  std::optional<std::array<double, 2>> dragged;  ///< over the curves, from frame to frame
  std::optional<std::size_t> toggled;            ///< curve whose legend entry was clicked
  std::optional<std::size_t> hovered;            ///< curve whose legend entry the mouse is over
  double moved = 0;                              ///< dragged by so many frames with another button
  double zoom = 0;                               ///< turns of the wheel
  double zoom_at = 0;                            ///< the frame under the mouse then
};

/// Draws a plot of `width` x `height` pixels into the current Dear ImGui window, in the colours of
/// its style: axes with ticks at round values, curves, legend, a crosshair with the values under
/// the mouse. Where several frames fall onto one pixel, a curve shows the range from the lowest to
/// the highest value. Takes as long for many frames as for few.
PlotResult drawPlot(const char* id, const std::vector<PlotCurve>& curves,
                    const PlotOptions& options, float width, float height);

/// Each pixel of a plot stands for so many blocks of 2^level frames, from one to two.
unsigned plotLevel(double frames_per_pixel);

/// A number with an SI prefix and three significant digits: "1.25 ms".
std::string withPrefix(double value, const char* unit);

/// About `count` round values for an axis from `low` to `high`. On a logarithmic axis (`low` > 0):
/// powers of ten, with 2 and 5 times these where there is room.
std::vector<double> axisTicks(double low, double high, int count, bool logarithmic);

}  // namespace broadmark
