// A plot of curves through a few points each, such as times over numbers of bodies, for the user
// interface.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "broadmark/render/colour.h"

namespace broadmark {

struct PlotPoint {
  double across = 0;
  double value = 0;
};

struct PointCurve {
  std::string label;
  Rgb colour = 0;
  std::vector<PlotPoint> points;  ///< from left to right
};

struct PointPlotOptions {
  bool logarithmic = false;  ///< the values; what they are plotted over always is
  const char* unit = "s";    ///< of the values, as in PlotOptions
  const char* across = "";   ///< what they are plotted over: "bodies"
};

/// A point by its numbers, and where it was drawn.
struct DrawnPoint {
  std::size_t curve = 0;
  std::size_t point = 0;
  ImVec2 at;
};

struct PointPlotResult {
  std::vector<DrawnPoint> drawn;
  std::optional<DrawnPoint> hovered;  ///< the one that the mouse means
  bool clicked = false;               ///< whether that was clicked
};

/// Draws a plot of `width` x `height` pixels into the current Dear ImGui window, in the colours of
/// its style. Below stand the numbers that points have, not round ones. All numbers are above 0.
PointPlotResult drawPointPlot(const char* id, const std::vector<PointCurve>& curves,
                              const PointPlotOptions& options, float width, float height);

}  // namespace broadmark
