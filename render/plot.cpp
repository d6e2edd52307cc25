#include "broadmark/render/plot.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace broadmark {
namespace {

constexpr float kLineWidth = 1.6F;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

ImU32 packed(Rgb rgb, unsigned alpha = 255) {
  return IM_COL32((rgb >> 16) & 255U, (rgb >> 8) & 255U, rgb & 255U, alpha);
}

/// The plotted area, and how values become pixels.
struct Axes {
  ImVec2 min;
  ImVec2 max;
  double first, last;  ///< frames
  double low, high;    ///< values
  bool logarithmic;

  [[nodiscard]] double scaled(double value) const {
    return logarithmic ? std::log10(std::max(value, std::numeric_limits<double>::min())) : value;
  }
  [[nodiscard]] float x(double frame) const {
    return min.x + static_cast<float>((frame - first) / (last - first)) * (max.x - min.x);
  }
  [[nodiscard]] float y(double value) const {
    const double at = (scaled(value) - scaled(low)) / (scaled(high) - scaled(low));
    return max.y - static_cast<float>(at) * (max.y - min.y);
  }
  [[nodiscard]] double frameAt(float pixel) const {
    return first + static_cast<double>((pixel - min.x) / (max.x - min.x)) * (last - first);
  }
};

double valueAt(const PlotCurve& curve, double frame) {
  const double index = std::round(frame);
  if (index < 0 || index >= static_cast<double>(curve.values.size())) return kNone;
  return curve.values[static_cast<std::size_t>(index)];
}

/// Lowest and highest shown value; NaN if there are none.
std::array<double, 2> valueRange(const std::vector<PlotCurve>& curves, const PlotOptions& options) {
  double low = kNone;
  double high = kNone;
  for (const PlotCurve& curve : curves) {
    if (curve.hidden) continue;
    const auto begin = static_cast<std::size_t>(std::max(0.0, std::floor(options.first)));
    const auto end = static_cast<std::size_t>(std::max(0.0, std::ceil(options.last) + 1));
    for (std::size_t i = begin; i < std::min(end, curve.values.size()); ++i) {
      const double value = curve.values[i];
      if (std::isnan(value) || (options.logarithmic && value <= 0)) continue;
      low = std::fmin(low, value);
      high = std::fmax(high, value);
    }
  }
  return {low, high};
}

void widen(std::array<double, 2>& range, bool logarithmic) {
  auto& [low, high] = range;
  if (std::isnan(low)) {
    low = logarithmic ? 1e-6 : 0;
    high = 1e-3;
  }
  if (logarithmic) {
    low *= 0.8;
    high *= 1.25;
    return;
  }
  low = std::min(low, 0.0);
  high = high > low ? low + (high - low) * 1.08 : low + 1;
}

/// Draws the range of the values that fall onto each pixel column.
void drawCurve(ImDrawList& draw, const PlotCurve& curve, const Axes& axes, float scale) {
  const ImU32 colour = packed(curve.colour);
  const auto count = static_cast<double>(curve.values.size());
  const auto begin = static_cast<std::size_t>(std::clamp(std::floor(axes.first), 0.0, count));
  const auto end = static_cast<std::size_t>(std::clamp(std::ceil(axes.last) + 1, 0.0, count));
  ImVec2 before{};
  bool joined = false;
  for (std::size_t i = begin; i < end;) {
    const float column = std::floor(axes.x(static_cast<double>(i)));
    double low = kNone;
    double high = kNone;
    std::size_t taken = 0;
    for (; i < end && (taken == 0 || std::floor(axes.x(static_cast<double>(i))) == column);
         ++i, ++taken) {
      low = std::fmin(low, curve.values[i]);
      high = std::fmax(high, curve.values[i]);
    }
    if (std::isnan(low)) {
      joined = false;
      continue;
    }
    const float x = taken == 1 ? axes.x(static_cast<double>(i - 1)) : column;
    const ImVec2 top{x, axes.y(high)};
    const ImVec2 bottom{x, axes.y(low)};
    if (joined) draw.AddLine(before, bottom, colour, kLineWidth * scale);
    if (taken > 1) draw.AddLine(top, {bottom.x, bottom.y + 1}, colour, kLineWidth * scale);
    if (!joined) draw.AddCircleFilled(bottom, kLineWidth * scale, colour, 8);
    before = bottom;
    joined = true;
  }
  for (const std::uint32_t frame : curve.disturbed) {
    if (frame < begin || frame >= end || std::isnan(curve.values[frame])) continue;
    draw.AddCircle({axes.x(frame), axes.y(curve.values[frame])}, 3.5F * scale, colour, 10, scale);
  }
}

struct PlotColours {
  ImU32 background, grid, text, marker, limit;
};

PlotColours plotColours(bool dark) {
  return dark ? PlotColours{packed(0x17191D), packed(0xFFFFFF, 22), packed(0xA3ACB8),
                            packed(0x3D8BFD), packed(0xF2B84B)}
              : PlotColours{packed(0xFFFFFF), packed(0x000000, 22), packed(0x565F6A),
                            packed(0x1F6FEB), packed(0x7A5200)};
}

void drawAxes(ImDrawList& draw, const Axes& axes, const PlotColours& colours, const char* unit) {
  const float line = ImGui::GetTextLineHeight();
  const int rows = std::max(2, static_cast<int>((axes.max.y - axes.min.y) / (2.2F * line)));
  for (const double value : axisTicks(axes.low, axes.high, rows, axes.logarithmic)) {
    const float y = axes.y(value);
    draw.AddLine({axes.min.x, y}, {axes.max.x, y}, colours.grid);
    const std::string text = withPrefix(value, unit);
    draw.AddText({axes.min.x - ImGui::CalcTextSize(text.c_str()).x - 5, y - line / 2}, colours.text,
                 text.c_str());
  }
  const int columns = std::max(2, static_cast<int>((axes.max.x - axes.min.x) / (6 * line)));
  for (const double frame : axisTicks(axes.first, axes.last, columns, false)) {
    if (frame != std::floor(frame)) continue;
    const float x = axes.x(frame);
    draw.AddLine({x, axes.min.y}, {x, axes.max.y}, colours.grid);
    const std::string text = fmt::format("{:.0f}", frame);
    draw.AddText({x - ImGui::CalcTextSize(text.c_str()).x / 2, axes.max.y + 2}, colours.text,
                 text.c_str());
  }
}

/// Width of the legend beside the curves; at most a third of the plot.
float legendWidth(const std::vector<PlotCurve>& curves, float plot_width) {
  if (curves.empty()) return 0;
  float width = 0;
  for (const PlotCurve& curve : curves) {
    width = std::max(width, ImGui::CalcTextSize(curve.label.c_str()).x);
  }
  return std::min(width + 1.8F * ImGui::GetTextLineHeightWithSpacing(), plot_width / 3);
}

/// Draws the legend at the right of the axes. Returns the entry under the mouse.
std::optional<std::size_t> drawLegend(ImDrawList& draw, const std::vector<PlotCurve>& curves,
                                      const Axes& axes, float width, const PlotColours& colours) {
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const std::size_t fitting =
      static_cast<std::size_t>(std::max(0.0F, (axes.max.y - axes.min.y) / line));
  std::optional<std::size_t> hovered;
  ImVec2 at{axes.max.x + line / 4, axes.min.y};
  for (std::size_t i = 0; i < std::min(curves.size(), fitting); ++i, at.y += line) {
    const PlotCurve& curve = curves[i];
    if (ImGui::IsMouseHoveringRect(at, {axes.max.x + width, at.y + line})) hovered = i;
    const unsigned alpha = curve.hidden ? 70 : 255;
    draw.AddRectFilled({at.x + line * 0.3F, at.y + line * 0.25F},
                       {at.x + line * 0.8F, at.y + line * 0.75F}, packed(curve.colour, alpha), 3);
    draw.AddText({at.x + line, at.y},
                 (colours.text & ~IM_COL32_A_MASK) | (ImU32{alpha} << IM_COL32_A_SHIFT),
                 curve.label.c_str());
  }
  return hovered;
}

/// A column of pixels for each frame whose value is known.
void drawBackdrop(ImDrawList& draw, const PlotCurve& curve, const Axes& axes) {
  double most = 0;
  for (const double value : curve.values) most = std::fmax(most, value);
  if (most == 0) return;
  for (float x = axes.min.x; x < axes.max.x; ++x) {
    const double value = valueAt(curve, axes.frameAt(x + 0.5F));
    if (std::isnan(value)) continue;
    const auto height = static_cast<float>(0.92 * value / most) * (axes.max.y - axes.min.y);
    draw.AddRectFilled({x, axes.max.y - height}, {x + 1, axes.max.y}, packed(curve.colour, 38));
    draw.AddRectFilled({x, axes.max.y - height - 1}, {x + 1, axes.max.y - height + 1},
                       packed(curve.colour, 120));
  }
}

/// At the border that it lies beyond, if it is out of range.
void drawLimit(ImDrawList& draw, const Axes& axes, const PlotOptions& options,
               const PlotColours& colours) {
  const float line = ImGui::GetTextLineHeight();
  const float y = std::clamp(axes.y(options.limit), axes.min.y, axes.max.y);
  const bool within = options.limit >= axes.low && options.limit <= axes.high;
  if (within) draw.AddLine({axes.min.x, y}, {axes.max.x, y}, colours.limit, line / 10);
  const std::string text = fmt::format("{}{}",
                                       within                      ? ""
                                       : options.limit > axes.high ? "↑ "
                                                                   : "↓ ",
                                       withPrefix(options.limit, options.unit));
  draw.AddText({axes.min.x + line / 3, y - axes.min.y < line ? y : y - line}, colours.limit,
               text.c_str());
}

void drawCrosshair(ImDrawList& draw, const std::vector<PlotCurve>& curves, const Axes& axes,
                   const PlotOptions& options, const PlotColours& colours) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const double frame = std::round(axes.frameAt(mouse.x));
  const float x = axes.x(frame);
  draw.AddLine({x, axes.min.y}, {x, axes.max.y}, colours.text);
  ImGui::BeginTooltip();
  ImGui::Text("frame %.0f", frame);
  bool known = false;
  for (const PlotCurve& curve : curves) {
    const double value = valueAt(curve, frame);
    if (curve.hidden || std::isnan(value)) continue;
    known = true;
    const bool disturbed = std::ranges::find(curve.disturbed, static_cast<std::uint32_t>(frame)) !=
                           curve.disturbed.end();
    ImGui::PushStyleColor(ImGuiCol_Text, packed(curve.colour));
    ImGui::TextUnformatted(curve.label.c_str());
    ImGui::PopStyleColor();
    ImGui::SameLine();
    ImGui::Text("%s%s", withPrefix(value, options.unit).c_str(), disturbed ? "  (disturbed)" : "");
    draw.AddCircleFilled({x, axes.y(value)}, 3, packed(curve.colour));
  }
  if (!known) ImGui::TextUnformatted("not run yet");
  if (options.backdrop != nullptr) {
    const double value = valueAt(*options.backdrop, frame);
    if (!std::isnan(value)) {
      ImGui::TextUnformatted(
          fmt::format("{} {}", options.backdrop->label, withPrefix(value, "")).c_str());
    }
  }
  ImGui::EndTooltip();
}

}  // namespace

std::string withPrefix(double value, const char* unit) {
  if (*unit == '\0') {
    return value >= 1e4 ? fmt::format("{:.3g}k", value / 1e3) : fmt::format("{:.4g}", value);
  }
  constexpr std::pair<double, const char*> kPrefixes[] = {
      {1, ""}, {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}};
  if (value == 0) return fmt::format("0 {}", unit);
  for (const auto& [factor, prefix] : kPrefixes) {
    if (std::abs(value) >= 0.9995 * factor) {
      return fmt::format("{:.3g} {}{}", value / factor, prefix, unit);
    }
  }
  return fmt::format("{:.3g} n{}", value * 1e9, unit);
}

std::vector<double> axisTicks(double low, double high, int count, bool logarithmic) {
  std::vector<double> ticks;
  if (!(high > low) || count < 1) return ticks;
  if (logarithmic) {
    const double decades = std::log10(high / low);
    const int per_decade = decades * 2 <= count ? 3 : 1;
    const int stride = std::max(1, static_cast<int>(std::ceil(decades / count)));
    constexpr double kSteps[] = {1, 2, 5};
    for (int power = static_cast<int>(std::floor(std::log10(low)));
         power <= static_cast<int>(std::ceil(std::log10(high))); ++power) {
      if (power % stride != 0) continue;
      for (int i = 0; i < per_decade; ++i) {
        const double tick = kSteps[i] * std::pow(10, power);
        if (tick >= low && tick <= high) ticks.push_back(tick);
      }
    }
    return ticks;
  }
  const double rough = (high - low) / count;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= rough) step = factor * power;
  }
  for (double index = std::ceil(low / step); index * step <= high; ++index) {
    ticks.push_back(index * step);
  }
  return ticks;
}

PlotResult drawPlot(const char* id, const std::vector<PlotCurve>& curves,
                    const PlotOptions& options, float width, float height) {
  PlotResult result;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton(id, {std::max(width, 1.0F), std::max(height, 1.0F)});
  const bool hovered = ImGui::IsItemHovered();
  const bool held = ImGui::IsItemActive();
  const float line = ImGui::GetTextLineHeight();
  std::array<double, 2> range = valueRange(curves, options);
  widen(range, options.logarithmic);
  const float legend = legendWidth(curves, width);
  const Axes axes{.min = {corner.x + 4.8F * line, corner.y + line / 2},
                  .max = {corner.x + width - 1.4F * line - legend, corner.y + height - 1.4F * line},
                  .first = options.first,
                  .last = std::max(options.last, options.first + 1),
                  .low = range[0],
                  .high = range[1],
                  .logarithmic = options.logarithmic};
  if (axes.max.x < axes.min.x + line || axes.max.y < axes.min.y + line) return result;

  const PlotColours colours = plotColours(options.dark);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(axes.min, axes.max, colours.background, 3);
  drawAxes(draw, axes, colours, options.unit);
  draw.PushClipRect(axes.min, axes.max, true);
  if (options.backdrop != nullptr) drawBackdrop(draw, *options.backdrop, axes);
  for (const PlotCurve& curve : curves) {
    if (!curve.hidden) drawCurve(draw, curve, axes, line / 15);
  }
  if (options.limit > 0) drawLimit(draw, axes, options, colours);
  if (options.marked_frame >= 0) {
    const float x = axes.x(options.marked_frame);
    draw.AddLine({x, axes.min.y}, {x, axes.max.y}, colours.marker, line / 10);
  }
  draw.PopClipRect();
  draw.PushClipRect(axes.min, {axes.max.x + legend, axes.max.y}, true);
  result.hovered = drawLegend(draw, curves, axes, legend, colours);
  draw.PopClipRect();

  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const auto within = [&](ImVec2 at) {
    return at.x >= axes.min.x && at.x <= axes.max.x && at.y >= axes.min.y && at.y <= axes.max.y;
  };
  const bool inside = within(mouse);
  if (!hovered && !held) result.hovered.reset();
  if (result.hovered && ImGui::IsMouseClicked(0)) {
    result.toggled = result.hovered;
  } else if (held && ImGui::IsMouseDown(0) && within(ImGui::GetIO().MouseClickedPos[0])) {
    result.clicked_frame = axes.frameAt(std::clamp(mouse.x, axes.min.x, axes.max.x));
  }
  if (hovered && inside && !result.hovered) drawCrosshair(draw, curves, axes, options, colours);
  if (hovered && ImGui::GetIO().MouseWheel != 0) {
    result.zoom = static_cast<double>(ImGui::GetIO().MouseWheel);
    result.zoom_at = axes.frameAt(mouse.x);
  }
  return result;
}

}  // namespace broadmark
