// Plots as SVG.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "broadmark/render/plot_canvas.h"

namespace broadmark {

/// An SVG document of the shapes within a rectangle of the window, with the current font's size and
/// the window's background. Lines that continue each other are one path.
std::string formatSvg(const std::vector<PlotShape>& shapes, ImVec2 min, ImVec2 max);

}  // namespace broadmark
