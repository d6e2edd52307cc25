#include "inspector/views/view_overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace broadmark {
namespace {

constexpr float kBackdrop = 0.82F;  // opacity behind text

/// Indexed by verdict.
constexpr Rgb Palette::* kVerdictColours[] = {&Palette::faint, &Palette::good, &Palette::bad,
                                              &Palette::warning};

/// A row of the legend; columns: meaning, count by the shown answer, count by the oracle's.
struct LegendRow {
  std::optional<Rgb> swatch;  ///< nothing: a heading
  std::array<std::string, 3> texts;
};

std::vector<LegendRow> legendRows(const ViewContent& content, const std::string& owner) {
  std::vector<LegendRow> rows;
  if (!content.oracle_legend.empty()) rows.push_back({{}, {"", owner, "oracle"}});
  for (std::size_t i = 0; i < content.colouring.legend.size(); ++i) {
    const LegendEntry& entry = content.colouring.legend[i];
    rows.push_back({entry.swatch, {entry.label, std::to_string(entry.count)}});
    if (!content.oracle_legend.empty())
      rows.back().texts[2] = std::to_string(content.oracle_legend[i].count);
  }
  if (!content.cell_legend.empty()) rows.push_back({{}, {"bodies in a cell", "cells"}});
  for (const LegendEntry& entry : content.cell_legend) {
    rows.push_back({entry.swatch, {entry.label, std::to_string(entry.count)}});
  }
  return rows;
}

}  // namespace

ImVec2 drawAnswer(const Ui& ui, const AnswerText& answer, ImVec2 corner, ImVec2 size) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float pad = 6 * ui.scale;
  const float max_width = size.x - 4 * pad;
  if (max_width < 60 * ui.scale || size.y < 120 * ui.scale) return corner;
  struct TextLine {
    ImFont* font;
    std::string text;
    ImU32 colour;
  };
  std::vector<TextLine> lines;
  // All in one size: large if they fit.
  const auto fits = [&](const std::string& text) {
    return ui.large->CalcTextSizeA(ui.large->FontSize, FLT_MAX, 0, text.c_str()).x <= max_width;
  };
  ImFont* const normal = ImGui::GetFont();
  ImFont* const large =
      fits(answer.where) && fits(answer.answer) && fits(answer.comparison) ? ui.large : normal;
  const auto add = [&](ImFont* font, const std::string& text, ImU32 rgb) {
    if (!text.empty()) lines.push_back({font, fittingText(text, max_width, font), rgb});
  };
  const ImU32 plain = ImGui::GetColorU32(ImGuiCol_Text);
  add(large, answer.where, plain);
  add(large, answer.answer, plain);
  add(large, answer.comparison,
      colour(ui.theme.*kVerdictColours[static_cast<std::size_t>(answer.verdict)]));
  add(normal, answer.pair, plain);
  add(normal, answer.waiting, colour(ui.theme.accent));

  float width = 0;
  float height = 0;
  for (const TextLine& line : lines) {
    const ImVec2 extent =
        line.font->CalcTextSizeA(line.font->FontSize, FLT_MAX, 0, line.text.c_str());
    width = std::max(width, extent.x);
    height += extent.y;
  }
  const ImVec2 at{corner.x + pad, corner.y + pad};
  const ImVec2 end{at.x + width + 2 * pad, at.y + height + pad};
  draw.AddRectFilled(at, end, colour(ui.theme.background, kBackdrop), 4 * ui.scale);
  float y = at.y + pad / 2;
  for (const TextLine& line : lines) {
    draw.AddText(line.font, line.font->FontSize, {at.x + pad, y}, line.colour, line.text.c_str());
    y += line.font->FontSize;
  }
  return end;
}

void drawDecidingAxis(const Ui& ui, const ViewContent::DecidingAxis& deciding,
                      const ViewProjection& projection, ImVec2 corner, ImVec2 size) {
  const auto& [x, y, z] = deciding.middle;
  const std::optional<Pixel> middle = projection.pixelOf({x, y, z});
  if (!middle || middle->x() < 0 || middle->x() > size.x || middle->y() < 0 ||
      middle->y() > size.y) {
    return;
  }
  const std::string text =
      fmt::format("{}: {} {}", kAxes[deciding.axis], kRelations.nameOf(deciding.relation.type),
                  std::abs(static_cast<float>(deciding.relation.gap)));
  const ImVec2 extent = ui.large->CalcTextSizeA(ui.large->FontSize, FLT_MAX, 0, text.c_str());
  const float pad = 6 * ui.scale;
  // Beside the boxes, away from the texts at the top.
  const float offset = std::min(size.x, size.y) / 4;
  const ImVec2 from{corner.x + middle->x(), corner.y + middle->y()};
  const float right = corner.x + size.x - extent.x - pad;
  const float bottom = corner.y + size.y - extent.y - pad;
  const ImVec2 at{std::max(std::min(from.x + offset, right), corner.x + pad),
                  std::max(std::min(from.y + offset, bottom), corner.y + pad)};
  const Rgb rgb = relationColour(ui.theme, deciding.relation.type);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddLine(from, at, colour(rgb), 1.5F * ui.scale);
  draw.AddRectFilled({at.x - pad, at.y}, {at.x + extent.x + pad, at.y + extent.y},
                     colour(ui.theme.background, kBackdrop), 4 * ui.scale);
  draw.AddText(ui.large, ui.large->FontSize, at, colour(rgb), text.c_str());
}

void drawReplay(Ui& ui, Session& session, ImVec2 at) {
  Mismatches& mismatches = session.mismatches;
  const std::uint32_t last = mismatches.examined()->frame;
  bool on = session.playback.replaying();
  const std::string label =
      on ? "Stop###Replay"
         : fmt::format("Replay frames {} to {}###Replay", mismatches.firstReplayed(), last);
  const float pad = 6 * ui.scale;
  ImGui::SetCursorScreenPos({at.x + pad, at.y + pad});
  ImGui::BeginChild(
      "Replay", {210 * ui.scale, ImGui::GetFrameHeight()}, false,
      ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NavFlattened);
  if (ui.toggle(label.c_str(), on, "Show how the pair came to be wrong, slowly")) {
    mismatches.toggleReplay();
  }
  ImGui::EndChild();
}

void drawLegend(const Ui& ui, const ViewContent& content, const std::string& owner, ImVec2 corner,
                ImVec2 size, ImVec2 answer_end) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const float pad = 0.5F * line;
  const std::vector<LegendRow> rows = legendRows(content, owner);
  std::array<float, 3> widths{};
  const std::size_t columns = content.oracle_legend.empty() ? 2 : widths.size();
  float width = line;
  for (std::size_t column = 0; column < columns; ++column) {
    for (const LegendRow& row : rows) {
      widths[column] = std::max(widths[column], ImGui::CalcTextSize(row.texts[column].c_str()).x);
    }
    width += widths[column] + pad;
  }
  const std::string left_out =
      content.left_out > 0 ? fmt::format("{} lines left out", content.left_out) : "";
  const auto height = static_cast<float>(rows.size() + (left_out.empty() ? 0 : 1)) * line;
  const float left = corner.x + size.x - width - 2 * pad;
  const float top = left > answer_end.x + pad ? corner.y : answer_end.y;
  const ImVec2 at{left, top + pad / 2};
  if (at.x < corner.x || at.y + height + pad > corner.y + size.y) return;
  draw.AddRectFilled(at, {at.x + width + pad, at.y + height + pad},
                     colour(ui.theme.background, kBackdrop), 4 * ui.scale);
  const ImU32 plain = ImGui::GetColorU32(ImGuiCol_Text);
  float y = at.y + pad / 2;
  for (const LegendRow& row : rows) {
    if (row.swatch) {
      draw.AddRectFilled({at.x + pad, y + 0.15F * line},
                         {at.x + pad + 0.6F * line, y + 0.75F * line}, colour(*row.swatch),
                         3 * ui.scale);
    }
    float x = at.x + pad + line;
    for (std::size_t column = 0; column < columns; ++column) {
      // Numbers are right-aligned.
      const char* text = row.texts[column].c_str();
      const float shift = column == 0 ? 0 : widths[column] - ImGui::CalcTextSize(text).x;
      draw.AddText({x + shift, y}, row.swatch ? plain : colour(ui.theme.faint), text);
      x += widths[column] + pad;
    }
    y += line;
  }
  if (!left_out.empty()) {
    draw.AddText({at.x + pad, y}, colour(ui.theme.warning), left_out.c_str());
  }
}

float drawTools(Ui& ui, Session& session, ImVec2 corner, ImVec2 size) {
  constexpr std::pair<Tool, const char*> kButtons[] = {
      {Tool::move, "Move the selected bodies by their handles (M)"},
      {Tool::turn, "Rotate the selected bodies about their common centre (T)"},
      {Tool::scale, "Scale the selected bodies about their common centre (R)"},
      {Tool::brush, "Paint bodies by clicks and drags (B)"}};
  Tools& tools = session.document.tools;
  const bool brush = tools.tool == Tool::brush;
  const char* hint = "Click or drag to paint; Escape to stop";
  const ImGuiStyle& style = ImGui::GetStyle();
  const float button = std::max(54 * ui.scale, Ui::buttonWidth("Rotate"));
  const float pad = 6 * ui.scale;
  const float gap = style.ItemSpacing.x;
  const float line = ImGui::GetFrameHeightWithSpacing();
  const float width = 4 * button + 3 * gap + 2 * pad;
  const float height = (brush ? 3 : 2) * line + 2 * pad - style.ItemSpacing.y;
  if (width > size.x || height + 2 * line > size.y) return size.y;
  const auto scope = ui.scope("Tools");
  ImGui::SetCursorScreenPos({corner.x + size.x - width - pad, corner.y + size.y - height - pad});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {pad, pad});
  ImGui::PushStyleVar(ImGuiStyleVar_ChildRounding, 4 * ui.scale);
  ImGui::PushStyleColor(ImGuiCol_ChildBg, colourVector(ui.theme.background, kBackdrop));
  ImGui::BeginChild("Tools", {width, height}, false,
                    ImGuiWindowFlags_AlwaysUseWindowPadding | ImGuiWindowFlags_NoScrollbar |
                        ImGuiWindowFlags_NavFlattened);
  if (brush) ui.coloured(ui.theme.accent, fittingText(hint, width - 2 * pad));
  ImGui::BeginDisabled(!session.document.atRest());
  for (const auto& [tool, tip] : kButtons) {
    if (tool != Tool::move) ImGui::SameLine();
    std::string label(kTools.nameOf(tool));
    label[0] = static_cast<char>(label[0] - 'a' + 'A');
    bool on = tools.tool == tool;
    if (ui.toggle(label.c_str(), on, tip, button)) tools.toggle(tool);
  }
  const float half = (width - 2 * pad - gap) / 2;
  ui.toggle("Local", tools.local, "Use the axes of the first selected body, not the world's (L)",
            half);
  ImGui::SameLine();
  ui.toggle("Snap", tools.snaps, "Drag in steps; Ctrl inverts this", half);
  ImGui::EndDisabled();
  ImGui::EndChild();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
  return size.y - height - pad;
}

}  // namespace broadmark
