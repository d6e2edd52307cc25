#include "broadmark/render/point_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "plot_parts.h"

namespace broadmark {
namespace {

constexpr float kPointRadius = 3.2F;    // for lines of text of 15 pixels
constexpr float kHoverRadius = 10;      // maximum distance of the mouse from a hovered point
constexpr double kMarginAcross = 0.05;  // margin beyond the outermost points, relative to the axis

/// Scales that contain all points.
struct PointAxes {
  PointAxes(const std::vector<PointCurve>& curves, bool logarithmic) {
    std::set<double> all_values;
    for (const PointCurve& curve : curves) {
      for (const PlotPoint& point : curve.points) {
        numbers.insert(point.across);
        all_values.insert(point.value);
      }
    }
    values.logarithmic = logarithmic;
    across.logarithmic = true;
    if (numbers.empty()) return;
    values.fit({static_cast<float>(*all_values.begin()), static_cast<float>(*all_values.rbegin())});
    const double margin =
        std::max(std::pow(*numbers.rbegin() / *numbers.begin(), kMarginAcross), 1.05);
    across.low = *numbers.begin() / margin;
    across.high = *numbers.rbegin() * margin;
  }

  [[nodiscard]] ImVec2 positionOf(const PlotPoint& point) const {
    return {across.pixelOf(point.across), values.pixelOf(point.value)};
  }

  std::set<double> numbers;  ///< the horizontal coordinates of the points
  PlotScale across;
  PlotScale values;
};

/// Draws lines at the points' numbers, their labels where they do not overlap, and the axis name.
void drawNumbers(PlotCanvas& draw, const PointAxes& axes, const char* across,
                 const PlotColours& colours) {
  const float top = axes.values.high_pixel;
  const float bottom = axes.values.low_pixel;
  float next_free_x = std::numeric_limits<float>::lowest();
  for (const double number : axes.numbers) {
    const float x = axes.across.pixelOf(number);
    draw.line({x, top}, {x, bottom}, colours.grid);
    const std::string text = withPrefix(number, "");
    const float half = ImGui::CalcTextSize(text.c_str()).x / 2;
    if (x - half < next_free_x) continue;
    draw.text({x - half, bottom + 2}, colours.text, text);
    next_free_x = x + half + ImGui::GetTextLineHeight() / 2;
  }
  draw.text({std::max(next_free_x, axes.across.high_pixel), bottom + 2}, colours.text, across);
}

void drawCurve(PlotCanvas& draw, const PointCurve& curve, const PointAxes& axes, float width) {
  const ImU32 colour = packed(curve.colour);
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const ImVec2 at = axes.positionOf(curve.points[i]);
    if (i > 0) draw.line(axes.positionOf(curve.points[i - 1]), at, colour, width);
    draw.disc(at, width * kPointRadius / kPlotLineWidth, colour, 16);
  }
}

std::optional<DrawnPoint> nearestTo(ImVec2 mouse, const std::vector<DrawnPoint>& drawn) {
  const auto distance = [&](const DrawnPoint& point) {
    return std::hypot(point.at.x - mouse.x, point.at.y - mouse.y);
  };
  const auto nearest = std::ranges::min_element(drawn, {}, distance);
  if (nearest == drawn.end() || distance(*nearest) > kHoverRadius) return {};
  return *nearest;
}

void drawTooltip(const PointCurve& curve, const PlotPoint& point, const PointPlotOptions& options) {
  ImGui::BeginTooltip();
  ImGui::PushStyleColor(ImGuiCol_Text, packed(curve.colour));
  ImGui::TextUnformatted(curve.label.c_str());
  ImGui::PopStyleColor();
  ImGui::Text("%s %s", withPrefix(point.across, "").c_str(), options.across);
  ImGui::TextUnformatted(withPrefix(point.value, options.unit).c_str());
  ImGui::EndTooltip();
}

}  // namespace

PointPlotResult drawPointPlot(const char* id, const std::vector<PointCurve>& curves,
                              const PointPlotOptions& options, float width, float height) {
  PointPlotResult result;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const bool pressed = ImGui::InvisibleButton(id, {std::max(width, 1.0F), std::max(height, 1.0F)});
  const bool hovered = ImGui::IsItemHovered();
  const float line = ImGui::GetTextLineHeight();
  std::vector<PlotEntry> entries;
  for (const PointCurve& curve : curves) {
    entries.push_back({.label = curve.label, .colour = curve.colour});
  }
  const float legend = std::max(legendWidth(entries, width), ImGui::CalcTextSize(options.across).x);
  const ImVec2 min{corner.x + 4.8F * line, corner.y + line / 2};
  const ImVec2 max{corner.x + width - line - legend, corner.y + height - 1.4F * line};
  if (max.x < min.x + line || max.y < min.y + line) return result;
  PointAxes axes(curves, options.logarithmic);
  axes.across.low_pixel = min.x;
  axes.across.high_pixel = max.x;
  axes.values.low_pixel = max.y;
  axes.values.high_pixel = min.y;

  const PlotColours colours;
  PlotCanvas draw(options.shapes);
  draw.filledRect(min, max, colours.background, 3);
  drawValueLines(draw, axes.values, min.x, max.x, options.unit, colours);
  drawNumbers(draw, axes, options.across, colours);
  const auto hovered_entry =
      drawLegend(draw, entries, {max.x + line / 2, min.y}, {corner.x + width, max.y}, colours);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const bool highlighted = hovered && hovered_entry == i;
    drawCurve(draw, curves[i], axes, (highlighted ? 2 : 1) * kPlotLineWidth * line / 15);
    for (std::size_t point = 0; point < curves[i].points.size(); ++point) {
      result.drawn.push_back(
          {.curve = i, .point = point, .at = axes.positionOf(curves[i].points[point])});
    }
  }
  draw.rect(min, max, colours.frame, 3);
  if (!hovered) return result;
  result.hovered = nearestTo(ImGui::GetIO().MousePos, result.drawn);
  result.clicked = pressed && result.hovered.has_value();
  if (result.hovered) {
    const PointCurve& curve = curves[result.hovered->curve];
    ImGui::GetWindowDrawList()->AddCircle(result.hovered->at, 2 * kPointRadius * line / 15,
                                          packed(curve.colour), 16);
    drawTooltip(curve, curve.points[result.hovered->point], options);
  }
  return result;
}

}  // namespace broadmark
