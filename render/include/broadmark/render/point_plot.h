// A plot of curves with a few points each for the user interface, such as times over numbers of
// bodies.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "broadmark/render/colour.h"
#include "broadmark/render/plot_canvas.h"

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
  bool logarithmic = false;                  ///< the vertical axis; the horizontal one always is
  const char* unit = "s";                    ///< of the values, as in PlotOptions
  const char* across = "";                   ///< name of the horizontal axis: "bodies"
  std::vector<PlotShape>* shapes = nullptr;  ///< see PlotCanvas
};

/// A drawn point: its indices, and its position in the window.
struct DrawnPoint {
  std::size_t curve = 0;
  std::size_t point = 0;
  ImVec2 at;
};

struct PointPlotResult {
  std::vector<DrawnPoint> drawn;
  std::optional<DrawnPoint> hovered;  ///< the point nearest to the mouse
  bool clicked = false;               ///< whether `hovered` was clicked
};

/// Draws a plot of `width` x `height` pixels into the current Dear ImGui window, in the colours of
/// its style. The horizontal axis has ticks at the points' numbers. All numbers are above 0.
PointPlotResult drawPointPlot(const char* id, const std::vector<PointCurve>& curves,
                              const PointPlotOptions& options, float width, float height);

}  // namespace broadmark
