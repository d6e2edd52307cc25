// If several frames share a pixel, the plot draws the largest blocks of frames that are no wider
// than a pixel, so the work depends only on the number of pixels.

#include "broadmark/render/plot.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "plot_parts.h"

namespace broadmark {
namespace {

constexpr float kThinLineWidth = 1;
constexpr float kMarkRow = 0.45F;  // in lines of text
constexpr float kClickPixels = 3;  // a press with less movement is a click
constexpr float kMarkRadius = 4;   // distance in pixels within which a click selects a mark

/// The plotted area, and the mapping from values to pixels.
struct Axes {
  ImVec2 min;
  ImVec2 max;
  double first, last;  ///< frames
  PlotScale vertical;

  [[nodiscard]] float x(double frame) const {
    return min.x + static_cast<float>((frame - first) / (last - first)) * (max.x - min.x);
  }
  [[nodiscard]] float y(double value) const { return vertical.pixelOf(value); }
  [[nodiscard]] double frameAt(float pixel) const {
    return first + static_cast<double>((pixel - min.x) / (max.x - min.x)) * (last - first);
  }
  /// The existing frame nearest to a pixel.
  [[nodiscard]] std::uint32_t nearestFrame(float pixel) const {
    return static_cast<std::uint32_t>(std::max(std::round(frameAt(pixel)), 0.0));
  }
  [[nodiscard]] bool contains(ImVec2 at) const {
    return at.x >= min.x && at.x <= max.x && at.y >= min.y && at.y <= max.y;
  }
  [[nodiscard]] unsigned level() const {
    return plotLevel((last - first) / static_cast<double>(max.x - min.x));
  }
  /// The range of the values of all frames that are at least partly visible.
  [[nodiscard]] FrameValues::Range valuesOf(const FrameValues& values) const {
    return values.within(static_cast<std::uint32_t>(first),
                         static_cast<std::uint32_t>(std::ceil(last)));
  }

  /// Calls `visit(from, to, range)` with the first and last frame of each visible block, including
  /// blocks with unknown values.
  template <class Visit>
  void eachBlock(const FrameValues& values, Visit&& visit) const {
    if (values.size() == 0) return;
    const unsigned level = this->level();
    const auto begin = static_cast<std::uint32_t>(first) >> level;
    const auto end =
        std::min(static_cast<std::uint32_t>(std::ceil(last)), values.size() - 1) >> level;
    for (std::uint32_t index = begin; index <= end; ++index) {
      const double from = static_cast<double>(std::uint64_t{index} << level);
      visit(from, from + static_cast<double>((std::uint64_t{1} << level) - 1),
            values.block(level, index));
    }
  }
};

/// Fits the scale to all values of the curves.
void fitScale(Axes& axes, const std::vector<const PlotCurve*>& curves) {
  FrameValues::Range range;
  for (const PlotCurve* curve : curves) {
    const FrameValues::Range shown = axes.valuesOf(*curve->values);
    range = {std::fmin(range.low, shown.low), std::fmax(range.high, shown.high)};
  }
  axes.vertical.fit(range);
}

void drawCurve(PlotCanvas& draw, const PlotCurve& curve, const Axes& axes, float width) {
  const ImU32 colour = packed(curve.colour);
  ImVec2 before{};
  bool joined = false;
  axes.eachBlock(*curve.values, [&](double from, double to, FrameValues::Range range) {
    if (!range.known()) {
      joined = false;
      return;
    }
    const float x = axes.x((from + to) / 2);
    const ImVec2 top{x, axes.y(range.high)};
    const ImVec2 bottom{x, axes.y(range.low)};
    if (joined) draw.line(before, bottom, colour, width);
    if (to > from) draw.line(top, {bottom.x, bottom.y + 1}, colour, width);
    if (!joined) draw.disc(bottom, width, colour, 8);
    before = bottom;
    joined = true;
  });
  if (curve.circled == nullptr || axes.level() > 0) return;
  axes.eachBlock(*curve.circled, [&](double frame, double, FrameValues::Range mark) {
    if (!mark.known()) return;
    const float value = curve.values->at(static_cast<std::uint32_t>(frame));
    draw.circle({axes.x(frame), axes.y(value)}, 2.2F * width, colour, 10, width / kPlotLineWidth);
  });
}

/// Draws the stack of the highest frame of each block.
void drawStack(PlotCanvas& draw, const std::vector<PlotCurve>& curves, const FrameValues& total,
               const Axes& axes) {
  axes.eachBlock(total, [&](double from, double to, FrameValues::Range range) {
    if (!range.known()) return;
    const auto frame =
        total.highest(static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to));
    const float left = std::floor(axes.x(from - 0.5));
    const float right = std::max(std::floor(axes.x(to + 0.5)), left + 1);
    double sum = 0;
    for (const PlotCurve& curve : curves) {
      const double value = curve.values->at(*frame);
      if (!(value > 0)) continue;
      const float bottom = axes.y(sum);
      sum += value;
      draw.filledRect({left, axes.y(sum)}, {right, bottom}, packed(curve.colour));
    }
  });
}

void drawArea(PlotCanvas& draw, const PlotCurve& curve, const Axes& axes) {
  const float max_value = curve.values->within(0, curve.values->size()).high;
  if (!(max_value > 0)) return;
  axes.eachBlock(*curve.values, [&](double from, double to, FrameValues::Range range) {
    if (!range.known()) return;
    const float left = std::floor(axes.x(from - 0.5));
    const float right = std::max(std::floor(axes.x(to + 0.5)), left + 1);
    const float top = axes.max.y - 0.92F * range.high / max_value * (axes.max.y - axes.min.y);
    draw.filledRect({left, top}, {right, axes.max.y}, packed(curve.colour, 38));
    draw.filledRect({left, top - 1}, {right, top + 1}, packed(curve.colour, 120));
  });
}

/// The label below the playhead with its frame, clamped to the border if invisible.
struct Flag {
  Flag(const Axes& axes, std::uint32_t frame) {
    const float line = ImGui::GetTextLineHeight();
    text =
        fmt::format("{}{}{}", frame < axes.first ? "← " : "", frame, frame > axes.last ? " →" : "");
    const float width = ImGui::CalcTextSize(text.c_str()).x + line / 2;
    const float left = std::clamp(axes.x(frame) - width / 2, axes.min.x, axes.max.x - width);
    min = {left, axes.max.y + 1};
    max = {left + width, min.y + line + 2};
  }

  std::string text;
  ImVec2 min, max;
};

void drawAxes(PlotCanvas& draw, const Axes& axes, const PlotOptions& options, const Flag& flag,
              const PlotColours& colours) {
  const float line = ImGui::GetTextLineHeight();
  drawValueLines(draw, axes.vertical, axes.min.x, axes.max.x, options.unit, colours);
  const int columns = std::max(2, static_cast<int>((axes.max.x - axes.min.x) / (6 * line)));
  for (const double frame : axisTicks(axes.first, axes.last, columns, false)) {
    if (frame != std::floor(frame)) continue;
    const float x = axes.x(frame);
    draw.line({x, axes.min.y}, {x, axes.max.y}, colours.grid);
    if (!options.frame_numbers) continue;
    const std::string text = fmt::format("{:.0f}", frame);
    const float half = ImGui::CalcTextSize(text.c_str()).x / 2;
    if (x + half > flag.min.x && x - half < flag.max.x) continue;
    draw.text({x - half, axes.max.y + 2}, colours.text, text);
  }
}

/// The axes of the thin curve.
Axes thinAxes(const PlotCurve& curve, const Axes& shown) {
  Axes axes = shown;
  axes.vertical.logarithmic = false;
  fitScale(axes, {&curve});
  return axes;
}

/// Draws the scale of the thin curve, at the right.
void drawThinScale(PlotCanvas& draw, const PlotCurve& curve, const Axes& axes) {
  for (const double value : valueTicks(axes.vertical)) {
    draw.text({axes.max.x + 4, axes.y(value) - ImGui::GetTextLineHeight() / 2},
              packed(curve.colour), withPrefix(value, ""));
  }
}

/// Draws the limit, clamped to the border if it is out of range.
void drawLimit(PlotCanvas& draw, const Axes& axes, const PlotOptions& options,
               const PlotColours& colours) {
  const float line = ImGui::GetTextLineHeight();
  const float y = std::clamp(axes.y(options.limit), axes.min.y, axes.max.y);
  const bool within = options.limit >= axes.vertical.low && options.limit <= axes.vertical.high;
  const ImU32 colour = packed(options.limit_colour);
  if (within) draw.line({axes.min.x, y}, {axes.max.x, y}, colour, line / 10);
  const std::string text = fmt::format("{}{}",
                                       within                               ? ""
                                       : options.limit > axes.vertical.high ? "↑ "
                                                                            : "↓ ",
                                       withPrefix(options.limit, options.unit));
  const ImVec2 at{axes.min.x + line / 3, y - axes.min.y < line ? y : y - line};
  const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
  draw.filledRect({at.x - 2, at.y + 1}, {at.x + extent.x + 2, at.y + extent.y - 1},
                  colours.background, 2);
  draw.text(at, colour, text);
}

/// The top of the rows of marks, which are above the axes, from top to bottom.
float marksTop(const Axes& axes, const PlotOptions& options) {
  return axes.min.y -
         kMarkRow * ImGui::GetTextLineHeight() * static_cast<float>(options.marks.size());
}

void drawMarks(PlotCanvas& draw, const Axes& axes, const PlotOptions& options) {
  const float row = kMarkRow * ImGui::GetTextLineHeight();
  float top = marksTop(axes, options);
  for (const PlotMarks& marks : options.marks) {
    for (const FrameValues* frames : marks.frames) {
      axes.eachBlock(*frames, [&](double from, double to, FrameValues::Range mark) {
        if (!mark.known()) return;
        const float x = axes.x((from + to) / 2);
        draw.filledRect({x - 1, top + 1}, {x + 1, top + row}, packed(marks.colour));
      });
    }
    top += row;
  }
}

/// The marked frame at the mouse.
std::optional<std::uint32_t> markedFrame(const Axes& axes, const PlotOptions& options,
                                         ImVec2 mouse) {
  const float row = (mouse.y - marksTop(axes, options)) / (kMarkRow * ImGui::GetTextLineHeight());
  if (row < 0 || row >= static_cast<float>(options.marks.size())) return {};
  std::optional<std::uint32_t> marked;
  for (const FrameValues* frames : options.marks[static_cast<std::size_t>(row)].frames) {
    const auto found = frames->firstKnown(axes.nearestFrame(mouse.x - kMarkRadius),
                                          axes.nearestFrame(mouse.x + kMarkRadius));
    if (found && (!marked || *found < *marked)) marked = found;
  }
  return marked;
}

/// The frame that a click at the mouse selects: a marked one, the peak of a stack, or the nearest.
std::uint32_t frameAtMouse(const Axes& axes, const PlotOptions& options, ImVec2 mouse) {
  if (const auto marked = markedFrame(axes, options, mouse)) return *marked;
  const std::uint32_t nearest = axes.nearestFrame(mouse.x);
  if (options.stack_total == nullptr) return nearest;
  return options.stack_total
      ->highest(axes.nearestFrame(mouse.x - kMarkRadius), axes.nearestFrame(mouse.x + kMarkRadius))
      .value_or(nearest);
}

void drawPlayhead(PlotCanvas& draw, const Axes& axes, const PlotOptions& options, const Flag& flag,
                  const PlotColours& colours) {
  const float x = axes.x(options.playhead);
  const float line = ImGui::GetTextLineHeight();
  if (x >= axes.min.x && x <= axes.max.x) {
    draw.line({x, marksTop(axes, options)}, {x, axes.max.y}, colours.playhead, line / 10);
  }
  if (!options.frame_numbers) return;
  draw.rect(flag.min, flag.max, colours.playhead, 3);
  draw.text({flag.min.x + line / 4, flag.min.y + 1}, colours.playhead, flag.text);
}

void drawTitle(PlotCanvas& draw, const Axes& axes, const PlotOptions& options,
               const PlotColours& colours) {
  if (options.title.empty()) return;
  const ImVec2 extent = ImGui::CalcTextSize(options.title.c_str());
  const ImVec2 at{axes.min.x + extent.y / 3, axes.min.y};
  draw.filledRect({at.x - 2, at.y}, {at.x + extent.x + 2, at.y + extent.y}, colours.background, 2);
  draw.text(at, ImGui::GetColorU32(ImGuiCol_Text), options.title);
}

void drawSpan(PlotCanvas& draw, const Axes& axes, const PlotOptions& options,
              const PlotColours& colours) {
  const float left = axes.x((*options.span)[0] - 0.5);
  const float right = std::max(axes.x((*options.span)[1] + 0.5), left + 1);
  draw.filledRect({left, axes.min.y}, {right, axes.max.y}, colours.span);
  draw.line({left, axes.min.y}, {left, axes.max.y}, colours.playhead);
  draw.line({right, axes.min.y}, {right, axes.max.y}, colours.playhead);
}

void writeValue(const PlotCurve* curve, std::uint32_t frame) {
  if (curve == nullptr || std::isnan(curve->values->at(frame))) return;
  const std::string text =
      fmt::format("{} {}", curve->label, withPrefix(curve->values->at(frame), ""));
  ImGui::TextUnformatted(text.c_str());
}

void drawCrosshair(const std::vector<PlotCurve>& curves, const Axes& axes,
                   const PlotOptions& options, std::uint32_t frame, const PlotColours& colours) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float x = axes.x(frame);
  draw.AddLine({x, axes.min.y}, {x, axes.max.y}, colours.text);
  ImGui::BeginTooltip();
  ImGui::Text("frame %u", frame);
  for (const PlotMarks& marks : options.marks) {
    const bool marked = std::ranges::any_of(
        marks.frames, [&](const FrameValues* frames) { return !std::isnan(frames->at(frame)); });
    if (!marked) continue;
    ImGui::SameLine();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(packed(marks.colour)), "%s",
                       marks.label.c_str());
  }
  bool known = false;
  for (const PlotCurve& curve : curves) {
    const double value = curve.values->at(frame);
    if (curve.hidden || std::isnan(value)) continue;
    known = true;
    ImGui::PushStyleColor(ImGuiCol_Text, packed(curve.colour));
    ImGui::TextUnformatted(curve.label.c_str());
    ImGui::PopStyleColor();
    ImGui::SameLine();
    ImGui::TextUnformatted(withPrefix(value, options.unit).c_str());
    if (options.stack_total == nullptr) {
      draw.AddCircleFilled({x, axes.y(value)}, 3, packed(curve.colour));
    }
  }
  if (known && options.stack_total != nullptr) {
    const double total = options.stack_total->at(frame);
    ImGui::Text("total %s", withPrefix(total, options.unit).c_str());
  }
  if (!known) ImGui::TextUnformatted("not run yet");
  writeValue(options.thin, frame);
  writeValue(options.area, frame);
  ImGui::EndTooltip();
}

/// The legend's entries: the curves, then the thin line and the area.
std::vector<PlotEntry> entriesOf(const std::vector<PlotCurve>& curves, const PlotOptions& options) {
  std::vector<PlotEntry> entries;
  const auto add = [&](const PlotCurve& curve) {
    entries.push_back({.label = curve.label, .colour = curve.colour, .hidden = curve.hidden});
  };
  if (options.stack_total != nullptr) return entries;
  std::ranges::for_each(curves, add);
  if (options.thin != nullptr) add(*options.thin);
  if (options.area != nullptr) add(*options.area);
  return entries;
}

/// Handles mouse input to the plot, which is the last item.
void handleMouse(const Axes& axes, const PlotOptions& options, PlotResult& result) {
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 pressed = io.MouseClickedPos[0];
  const double frame_at_mouse = axes.frameAt(std::clamp(io.MousePos.x, axes.min.x, axes.max.x));
  const bool across = pressed.x >= axes.min.x && pressed.x <= axes.max.x;
  const bool on_labels = across && pressed.y > axes.max.y;
  const bool is_drag = io.MouseDragMaxDistanceSqr[0] > kClickPixels * kClickPixels;
  if (ImGui::IsItemActive() && io.MouseDown[0]) {
    if (on_labels) {
      result.clicked_frame = frame_at_mouse;
    } else if (across && is_drag) {
      result.dragged = {axes.frameAt(pressed.x), frame_at_mouse};
    }
  } else if (ImGui::IsItemActive() && (io.MouseDown[1] || io.MouseDown[2])) {
    result.moved = axes.frameAt(0) - axes.frameAt(io.MouseDelta.x);
  }
  if (ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(0) && across && !is_drag) {
    result.clicked_frame = frameAtMouse(axes, options, pressed);
  }
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    result.zoom = static_cast<double>(io.MouseWheel);
    result.zoom_at = frame_at_mouse;
  }
}

}  // namespace

unsigned plotLevel(double frames_per_pixel) {
  return frames_per_pixel < 2 ? 0 : static_cast<unsigned>(std::log2(frames_per_pixel));
}

std::string withPrefix(double value, const char* unit) {
  constexpr double kRounded = 0.9995;  // becomes 1 with three digits
  const double size = std::abs(value);
  if (*unit == '\0') {
    constexpr std::pair<double, const char*> kPrefixes[] = {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}};
    if (size < kRounded * 1e4 && std::fmod(size, 100) != 0) return fmt::format("{:.4g}", value);
    for (const auto& [factor, prefix] : kPrefixes) {
      if (size >= kRounded * factor) return fmt::format("{:.3g}{}", value / factor, prefix);
    }
    return fmt::format("{:.3g}", value);
  }
  constexpr std::pair<double, const char*> kPrefixes[] = {
      {1, ""}, {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}};
  if (value == 0) return fmt::format("0 {}", unit);
  if (size >= kRounded * 1e3) return fmt::format("{:.0f} {}", value, unit);
  for (const auto& [factor, prefix] : kPrefixes) {
    if (size >= kRounded * factor) {
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
    // One label alone would not show the scale.
    if (ticks.size() > 1 || count == 1) return ticks;
    if (decades >= 1) return axisTicks(low, high, count + 1, true);
    ticks.clear();
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
  return ticks.size() < 2 && count > 1 ? axisTicks(low, high, count + 1, false) : ticks;
}

PlotResult drawPlot(const char* id, const std::vector<PlotCurve>& curves,
                    const PlotOptions& options, float width, float height) {
  PlotResult result;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton(id, {std::max(width, 1.0F), std::max(height, 1.0F)},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  const float line = ImGui::GetTextLineHeight();
  const std::vector<PlotEntry> entries = entriesOf(curves, options);
  const float legend = legendWidth(entries, width);
  const float right_scale = options.thin != nullptr ? 3.2F * line : 1.4F * line;
  const float marks = kMarkRow * line * static_cast<float>(options.marks.size());
  Axes axes{.min = {corner.x + 4.8F * line, corner.y + std::max(line / 2, marks)},
            .max = {corner.x + width - right_scale - legend,
                    corner.y + height - (options.frame_numbers ? 1.4F : 0.5F) * line},
            .first = options.first,
            .last = std::max(options.last, options.first + 1),
            .vertical = {.logarithmic = options.logarithmic}};
  axes.vertical.low_pixel = axes.max.y;
  axes.vertical.high_pixel = axes.min.y;
  if (axes.max.x < axes.min.x + line || axes.max.y < axes.min.y + line) return result;
  std::vector<const PlotCurve*> shown;
  for (const PlotCurve& curve : curves) {
    if (!curve.hidden) shown.push_back(&curve);
  }
  if (options.stack_total != nullptr) {
    const float high = axes.valuesOf(*options.stack_total).high;
    axes.vertical.fit({0, std::fmax(high, static_cast<float>(options.least_top))});
  } else {
    fitScale(axes, shown);
  }

  const PlotColours colours;
  PlotCanvas draw(options.shapes);
  draw.filledRect(axes.min, axes.max, colours.background, 3);
  const Flag flag(axes, options.playhead);
  drawAxes(draw, axes, options, flag, colours);
  draw.clip(axes.min, axes.max);
  if (options.area != nullptr) drawArea(draw, *options.area, axes);
  if (options.span) drawSpan(draw, axes, options, colours);
  if (options.thin != nullptr) {
    drawCurve(draw, *options.thin, thinAxes(*options.thin, axes), kThinLineWidth * line / 15);
  }
  if (options.stack_total != nullptr) {
    drawStack(draw, curves, *options.stack_total, axes);
  } else {
    for (const PlotCurve* curve : shown) drawCurve(draw, *curve, axes, kPlotLineWidth * line / 15);
  }
  drawTitle(draw, axes, options, colours);
  draw.unclip();
  if (options.thin != nullptr) drawThinScale(draw, *options.thin, thinAxes(*options.thin, axes));
  draw.rect(axes.min, axes.max, colours.frame, 3);
  drawMarks(draw, axes, options);
  drawPlayhead(draw, axes, options, flag, colours);
  draw.clip(axes.min, axes.max);
  if (options.limit > 0) drawLimit(draw, axes, options, colours);
  draw.unclip();
  const ImVec2 legend_min{corner.x + width - legend, axes.min.y};
  result.hovered = drawLegend(draw, entries, legend_min, {corner.x + width, axes.max.y}, colours);

  const bool hovered = ImGui::IsItemHovered();
  if (!hovered && !ImGui::IsItemActive()) result.hovered.reset();
  if (result.hovered >= curves.size()) result.hovered.reset();
  if (result.hovered && ImGui::IsMouseClicked(0)) result.toggled = result.hovered;
  handleMouse(axes, options, result);
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (hovered && (axes.contains(mouse) || markedFrame(axes, options, mouse))) {
    drawCrosshair(curves, axes, options, frameAtMouse(axes, options, mouse), colours);
  }
  return result;
}

}  // namespace broadmark
