#include "broadmark/render/plot_canvas.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace broadmark {

using Kind = PlotShape::Kind;

void PlotCanvas::line(ImVec2 from, ImVec2 to, ImU32 colour, float width) {
  draw_.AddLine(from, to, colour, width);
  add({.kind = Kind::line, .from = from, .to = to, .colour = colour, .size = width});
}

void PlotCanvas::filledRect(ImVec2 min, ImVec2 max, ImU32 colour, float rounding) {
  draw_.AddRectFilled(min, max, colour, rounding);
  add({.kind = Kind::filled_rect, .from = min, .to = max, .colour = colour, .size = rounding});
}

void PlotCanvas::rect(ImVec2 min, ImVec2 max, ImU32 colour, float rounding) {
  draw_.AddRect(min, max, colour, rounding);
  add({.kind = Kind::rect, .from = min, .to = max, .colour = colour, .size = rounding});
}

void PlotCanvas::disc(ImVec2 centre, float radius, ImU32 colour, int segments) {
  draw_.AddCircleFilled(centre, radius, colour, segments);
  add({.kind = Kind::disc, .from = centre, .to = centre, .colour = colour, .size = radius});
}

void PlotCanvas::circle(ImVec2 centre, float radius, ImU32 colour, int segments, float width) {
  draw_.AddCircle(centre, radius, colour, segments, width);
  add({.kind = Kind::circle,
       .from = centre,
       .to = centre,
       .colour = colour,
       .size = radius,
       .width = width});
}

void PlotCanvas::text(ImVec2 at, ImU32 colour, std::string_view text, float right) {
  const char* const end = text.data() + text.size();
  if (std::isinf(right)) {
    draw_.AddText(at, colour, text.data(), end);
  } else {
    const ImVec2 corner{right, at.y + ImGui::GetTextLineHeightWithSpacing()};
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::RenderTextEllipsis(&draw_, at, corner, right, right, text.data(), end, nullptr);
    ImGui::PopStyleColor();
  }
  if (shapes_ == nullptr) return;
  const float end_x = std::min(at.x + ImGui::CalcTextSize(text.data(), end).x, right);
  add({.kind = Kind::text,
       .from = at,
       .to = {end_x, at.y},
       .colour = colour,
       .text = std::string(text)});
}

void PlotCanvas::clip(ImVec2 min, ImVec2 max) {
  draw_.PushClipRect(min, max, true);
  add({.kind = Kind::clip, .from = min, .to = max});
}

void PlotCanvas::unclip() {
  draw_.PopClipRect();
  add({.kind = Kind::unclip, .from = {}, .to = {}});
}

}  // namespace broadmark
