#include "plot_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace broadmark {
namespace {

float widthOf(std::string_view text) {
  return ImGui::CalcTextSize(text.data(), text.data() + text.size()).x;
}

}  // namespace

ImU32 packed(Rgb rgb, unsigned alpha) {
  return IM_COL32((rgb >> 16) & 255U, (rgb >> 8) & 255U, rgb & 255U, alpha);
}

double PlotScale::scaled(double number) const {
  return logarithmic ? std::log10(std::max(number, std::numeric_limits<double>::min())) : number;
}

float PlotScale::pixelOf(double number) const {
  const double at = (scaled(number) - scaled(low)) / (scaled(high) - scaled(low));
  return low_pixel + static_cast<float>(at) * (high_pixel - low_pixel);
}

void PlotScale::fit(FrameValues::Range range) {
  if (!range.known()) range = {logarithmic ? 1e-6F : 0.0F, 1e-3F};
  low = range.low;
  high = range.high;
  if (logarithmic) {
    if (high <= 0) high = 1;
    if (low <= 0) low = 1e-3 * high;
    low *= 0.8;
    high *= 1.25;
    return;
  }
  low = std::min(low, 0.0);
  high = high > low ? low + (high - low) * 1.08 : low + 1;
}

std::vector<double> valueTicks(const PlotScale& scale) {
  const float line = ImGui::GetTextLineHeight();
  const float height = std::abs(scale.high_pixel - scale.low_pixel);
  const int rows = std::max(2, static_cast<int>(height / (2.2F * line)));
  std::vector<double> ticks;
  for (const double tick : axisTicks(scale.low, scale.high, rows, scale.logarithmic)) {
    const bool is_separate =
        ticks.empty() || std::abs(scale.pixelOf(ticks.back()) - scale.pixelOf(tick)) >= line;
    if (is_separate) ticks.push_back(tick);
  }
  return ticks;
}

void drawValueLines(PlotCanvas& draw, const PlotScale& scale, float left, float right,
                    const char* unit, const PlotColours& colours) {
  for (const double value : valueTicks(scale)) {
    const float y = scale.pixelOf(value);
    draw.line({left, y}, {right, y}, colours.grid);
    const std::string text = withPrefix(value, unit);
    draw.text({left - widthOf(text) - 5, y - ImGui::GetTextLineHeight() / 2}, colours.text, text);
  }
}

float legendWidth(std::span<const PlotEntry> entries, float plot_width) {
  if (entries.empty()) return 0;
  float width = 0;
  for (const PlotEntry& entry : entries) width = std::max(width, widthOf(entry.label));
  return std::min(width + 1.8F * ImGui::GetTextLineHeightWithSpacing(), plot_width / 3);
}

std::optional<std::size_t> drawLegend(PlotCanvas& draw, std::span<const PlotEntry> entries,
                                      ImVec2 min, ImVec2 max, const PlotColours& colours) {
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const std::size_t fitting = static_cast<std::size_t>(std::max(0.0F, (max.y - min.y) / line));
  std::optional<std::size_t> hovered;
  ImVec2 at{min.x + line / 4, min.y};
  for (std::size_t i = 0; i < std::min(entries.size(), fitting); ++i, at.y += line) {
    const PlotEntry& entry = entries[i];
    if (ImGui::IsMouseHoveringRect(at, {max.x, at.y + line})) hovered = i;
    const unsigned alpha = entry.hidden ? 70 : 255;
    draw.filledRect({at.x + line * 0.3F, at.y + line * 0.25F},
                    {at.x + line * 0.8F, at.y + line * 0.75F}, packed(entry.colour, alpha), 3);
    draw.text({at.x + line, at.y},
              (colours.text & ~IM_COL32_A_MASK) | (ImU32{alpha} << IM_COL32_A_SHIFT), entry.label,
              max.x);
  }
  return hovered;
}

}  // namespace broadmark
