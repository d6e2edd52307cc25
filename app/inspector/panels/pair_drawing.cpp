#include "inspector/panels/pair_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace broadmark {
namespace {

/// Returns the shortest text that parses to the same float.
std::string exactText(float value) { return fmt::format("{}", value); }

void cell(Ui& ui, Rgb rgb, const std::string& upper, const std::string& lower) {
  ImGui::TableNextColumn();
  ui.coloured(rgb, upper);
  ui.coloured(rgb, lower);
}

void plainRect(ImVec2 min, ImVec2 max, Rgb rgb, float alpha, float rounding = 0) {
  ImGui::GetWindowDrawList()->AddRectFilled(min, max, colour(rgb, alpha), rounding);
}

void labelAt(ImVec2 at, Rgb rgb, const char* text) {
  ImGui::GetWindowDrawList()->AddText(at, colour(rgb), text);
}

}  // namespace

void drawPairTable(Ui& ui, const BoxPair& pair) {
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {4 * ui.scale, 2 * ui.scale});
  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_BordersInnerH |
                                     ImGuiTableFlags_SizingFixedFit |
                                     ImGuiTableFlags_NoHostExtendX | ImGuiTableFlags_ScrollX;
  const float line = ImGui::GetTextLineHeight() + ImGui::GetStyle().ItemSpacing.y;
  // The relation of both is a column or, in a narrow panel, a line below.
  const bool narrow = ImGui::GetContentRegionAvail().x < 270 * ui.scale;
  const float height = (narrow ? 10 : 7) * line + 4 * ui.scale;
  if (ImGui::BeginTable("pair", narrow ? 3 : 4, kFlags, {0, height})) {
    const std::size_t deciding = maxSeparationAxis(pair.a, pair.b);
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TableNextColumn();
    ui.coloured(ui.theme.first, fmt::format("body {}", pair.bodies.a));
    ImGui::TableNextColumn();
    ui.coloured(ui.theme.second, fmt::format("body {}", pair.bodies.b));
    for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
      const AxisRelation relation = axisRelation(axis, pair.a, pair.b);
      const Rgb rgb = relationColour(ui.theme, relation.type);
      ImGui::TableNextRow();
      cell(ui, axis == deciding ? ui.theme.accent : ui.theme.faint, kAxes[axis], "");
      if (axis == deciding)
        ui.tooltip("Deciding axis: the largest gap or, without a gap, the smallest overlap");
      const std::string kind(kRelations.nameOf(relation.type));
      const std::string extent = exactText(std::abs(static_cast<float>(relation.gap)));
      cell(ui, ui.theme.text, exactText(pair.a.min[axis]), exactText(pair.a.max[axis]));
      if (narrow) ui.coloured(rgb, kind);
      cell(ui, ui.theme.text, exactText(pair.b.min[axis]), exactText(pair.b.max[axis]));
      if (narrow) ui.coloured(rgb, extent);
      if (!narrow) cell(ui, rgb, kind, extent);
    }
    ImGui::EndTable();
  }
  ImGui::PopStyleVar();
}

void drawIntervals(Ui& ui, const BoxPair& pair) {
  const float unit = ui.scale;
  const float bar = 9 * unit;
  const float row = 2 * bar + 11 * unit;
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  const float label = 18 * unit;
  const float width = std::max(ImGui::GetContentRegionAvail().x - label, 10 * unit);
  ImGui::Dummy({label + width, 3 * row});
  ui.note("intervals");

  double extent = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    extent = std::max<double>(extent, std::max(pair.a.max[axis], pair.b.max[axis]) -
                                          std::min(pair.a.min[axis], pair.b.min[axis]));
  }
  if (!(extent > 0) || !std::isfinite(extent)) extent = 1;
  const double per_unit = static_cast<double>(width) / extent;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double centre = (static_cast<double>(std::max(pair.a.max[axis], pair.b.max[axis])) +
                           static_cast<double>(std::min(pair.a.min[axis], pair.b.min[axis]))) /
                          2;
    const auto x = [&](float value) {
      const double offset = (static_cast<double>(value) - centre) * per_unit;
      return origin.x + label + width / 2 + static_cast<float>(offset);
    };
    const float top = origin.y + static_cast<float>(axis) * row + 4 * unit;
    const AxisRelation relation = axisRelation(axis, pair.a, pair.b);
    const Rgb rgb = relationColour(ui.theme, relation.type);
    labelAt({origin.x, top + bar - ImGui::GetTextLineHeight() / 2}, ui.theme.faint, kAxes[axis]);
    // The gap or overlap of the intervals, at least 2 units wide.
    float low = x(std::max(pair.a.min[axis], pair.b.min[axis]));
    float high = x(std::min(pair.a.max[axis], pair.b.max[axis]));
    if (low > high) std::swap(low, high);
    if (high - low < 2 * unit) {
      low = (low + high) / 2 - unit;
      high = low + 2 * unit;
    }
    const ImVec2 band_min{low, top - 3 * unit};
    const ImVec2 band_max{high, top + 2 * bar + 5 * unit};
    const auto draw_bar = [&](const Aabb& box, float y, Rgb shade) {
      plainRect({x(box.min[axis]), y},
                {std::max(x(box.max[axis]), x(box.min[axis]) + unit), y + bar}, shade, 0.85F,
                2 * unit);
    };
    draw_bar(pair.a, top, ui.theme.first);
    draw_bar(pair.b, top + bar + 2 * unit, ui.theme.second);
    plainRect(band_min, band_max, rgb, 0.35F);
    ImGui::GetWindowDrawList()->AddRect(band_min, band_max, colour(rgb));
  }
}

std::optional<std::uint32_t> drawPairHistory(Ui& ui, const PairTrails& trail) {
  const float unit = ui.scale;
  const float row = 26 * unit;
  const float strip = ImGui::GetTextLineHeight();
  const float label = 46 * unit;
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  const float width = std::max(ImGui::GetContentRegionAvail().x - label, 10 * unit);
  const float moved_top = 3 * row + 4 * unit;
  const float height = moved_top + 2 * strip + 4 * unit;
  ImGui::InvisibleButton("history", {label + width, height});
  ui.note("history");
  const std::size_t frames = trail.size();
  if (frames == 0) return {};
  const float step = width / static_cast<float>(frames);
  const auto left = [&](std::size_t i) { return origin.x + label + static_cast<float>(i) * step; };
  const auto right = [&](std::size_t i) {
    return std::max(left(i) + unit, left(i + 1) - (step > 3 * unit ? unit : 0));
  };

  const std::optional<std::uint32_t> overlap_start = trail.overlapStart();
  if (overlap_start) {
    plainRect({left(*overlap_start - trail.a.first), origin.y},
              {origin.x + label + width, origin.y + height}, ui.theme.good, 0.10F);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double max_gap = 0;
    for (std::size_t i = 0; i < frames; ++i) {
      const double gap = std::abs(trail.relationAt(i, axis).gap);
      if (std::isfinite(gap)) max_gap = std::max(max_gap, gap);
    }
    const float top = origin.y + static_cast<float>(axis) * row;
    const float zero = top + row / 2;
    labelAt({origin.x, zero - ImGui::GetTextLineHeight() / 2}, ui.theme.faint, kAxes[axis]);
    plainRect({origin.x + label, zero}, {origin.x + label + width, zero + 1}, ui.theme.faint, 0.4F);
    for (std::size_t i = 0; i < frames; ++i) {
      if (isEmpty(trail.a.boxes[i]) || isEmpty(trail.b.boxes[i])) continue;
      const AxisRelation relation = trail.relationAt(i, axis);
      const double share = max_gap > 0 ? relation.gap / max_gap : 0;
      const float extent = static_cast<float>(share) * (row / 2 - 2 * unit);
      // At least 1.5 units high.
      const float end =
          extent < 0 ? zero + std::max(-extent, 1.5F * unit) : zero - std::max(extent, 1.5F * unit);
      plainRect({left(i), std::min(zero, end)}, {right(i), std::max(zero, end)},
                relationColour(ui.theme, relation.type), 0.9F);
    }
  }
  const auto draw_moves = [&](const Trail& body, float y, Rgb rgb) {
    const std::string name = fmt::format("{}", body.body);
    labelAt({origin.x, y + strip / 2 - ImGui::GetTextLineHeight() / 2}, rgb, name.c_str());
    for (std::size_t i = 0; i < frames; ++i) {
      if (isEmpty(body.boxes[i])) continue;
      plainRect({left(i), y + 4 * unit}, {right(i), y + strip - 4 * unit}, rgb,
                movedAt(body, i) ? 0.9F : 0.15F);
    }
  };
  draw_moves(trail.a, origin.y + moved_top, ui.theme.first);
  draw_moves(trail.b, origin.y + moved_top + strip, ui.theme.second);

  if (!ImGui::IsItemHovered()) return {};
  const float offset = (ImGui::GetIO().MousePos.x - origin.x - label) / step;
  const auto at =
      static_cast<std::size_t>(std::clamp(offset, 0.0F, static_cast<float>(frames - 1)));
  plainRect({left(at), origin.y}, {right(at), origin.y + height}, ui.theme.text, 0.18F);
  const std::uint32_t frame = trail.a.first + static_cast<std::uint32_t>(at);
  std::string text = fmt::format("frame {}", frame);
  for (const Trail* body : {&trail.a, &trail.b}) {
    if (isEmpty(body->boxes[at])) text += fmt::format("\nbody {} is absent", body->body);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (isEmpty(trail.a.boxes[at]) || isEmpty(trail.b.boxes[at])) break;
    const AxisRelation relation = trail.relationAt(at, axis);
    text += fmt::format("\n{}: {} {}", kAxes[axis], kRelations.nameOf(relation.type),
                        exactText(std::abs(static_cast<float>(relation.gap))));
  }
  ImGui::SetTooltip("%s", text.c_str());
  if (!ImGui::IsMouseClicked(0)) return {};
  return frame;
}

}  // namespace broadmark
