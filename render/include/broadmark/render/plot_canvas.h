// What plots draw with: lines, rectangles, circles and texts, into the current Dear ImGui window,
// and into a list from which files are written.
#pragma once

#include <imgui.h>

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark {

/// A part of a drawn plot, in pixels of the window.
struct PlotShape {
  enum class Kind { line, filled_rect, rect, disc, circle, text, clip, unclip };
  Kind kind = Kind::line;
  ImVec2 from;  ///< or a centre, a corner, the upper left of a text
  ImVec2 to;    ///< or the opposite corner, the upper right of a text
  ImU32 colour = 0;
  float size = 0;   ///< width of a line, rounding of a rectangle, radius
  float width = 1;  ///< of a circle's line
  std::string text = {};
};

class PlotCanvas {
 public:
  /// `shapes`: receives all that is drawn; null: it is not needed.
  explicit PlotCanvas(std::vector<PlotShape>* shapes)
      : draw_(*ImGui::GetWindowDrawList()), shapes_(shapes) {}

  void line(ImVec2 from, ImVec2 to, ImU32 colour, float width = 1);
  void filledRect(ImVec2 min, ImVec2 max, ImU32 colour, float rounding = 0);
  void rect(ImVec2 min, ImVec2 max, ImU32 colour, float rounding);
  void disc(ImVec2 centre, float radius, ImU32 colour, int segments);
  void circle(ImVec2 centre, float radius, ImU32 colour, int segments, float width);
  /// A text that would pass `right` ends with "…" in the window.
  void text(ImVec2 at, ImU32 colour, std::string_view text,
            float right = std::numeric_limits<float>::infinity());
  /// Clips what follows, until unclip().
  void clip(ImVec2 min, ImVec2 max);
  void unclip();

 private:
  void add(PlotShape shape) {
    if (shapes_ != nullptr) shapes_->push_back(std::move(shape));
  }

  ImDrawList& draw_;
  std::vector<PlotShape>* shapes_;
};

}  // namespace broadmark
