// Parts of plots: scales, grid lines, a legend.
#pragma once

#include <imgui.h>

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "broadmark/render/plot.h"
#include "broadmark/render/plot_canvas.h"

namespace broadmark {

constexpr float kPlotLineWidth = 1.6F;

ImU32 packed(Rgb rgb, unsigned alpha = 255);

/// The colours of a plot's parts, from Dear ImGui's style.
struct PlotColours {
  ImU32 background = ImGui::GetColorU32(ImGuiCol_WindowBg);
  ImU32 frame = ImGui::GetColorU32(ImGuiCol_Border);
  ImU32 grid = ImGui::GetColorU32(ImGuiCol_TextDisabled, 0.2F);
  ImU32 text = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  ImU32 playhead = ImGui::GetColorU32(ImGuiCol_CheckMark);
  ImU32 span = ImGui::GetColorU32(ImGuiCol_CheckMark, 0.15F);
};

/// The mapping from numbers to pixels along an axis.
struct PlotScale {
  double low = 0;
  double high = 1;
  bool logarithmic = false;
  float low_pixel = 0;
  float high_pixel = 1;

  [[nodiscard]] double scaled(double number) const;
  [[nodiscard]] float pixelOf(double number) const;
  /// Sets the scale to a range with margins; a linear scale starts at 0.
  void fit(FrameValues::Range range);
};

/// Grid lines at round values of a vertical scale, from `left` to `right`, with the values at the
/// left.
void drawValueLines(PlotCanvas& draw, const PlotScale& scale, float left, float right,
                    const char* unit, const PlotColours& colours);
/// Round values of a vertical scale, at distances that keep their labels apart.
std::vector<double> valueTicks(const PlotScale& scale);

struct PlotEntry {
  std::string_view label;
  Rgb colour = 0;
  bool hidden = false;
};

/// Width of the legend beside the curves; at most a third of the plot.
float legendWidth(std::span<const PlotEntry> entries, float plot_width);
/// Draws the legend into an area. Returns the entry under the mouse.
std::optional<std::size_t> drawLegend(PlotCanvas& draw, std::span<const PlotEntry> entries,
                                      ImVec2 min, ImVec2 max, const PlotColours& colours);

}  // namespace broadmark
