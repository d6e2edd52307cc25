#include "inspector/ui/svg.h"

#include <fmt/format.h>

#include <utility>

#include "support/words.h"

namespace broadmark {
namespace {

using Kind = PlotShape::Kind;

/// ` fill="#ff8000" fill-opacity="0.5"`; `property`: "fill" or "stroke".
std::string paint(const char* property, ImU32 colour) {
  const auto part = [colour](int shift) { return colour >> shift & 255U; };
  std::string text = fmt::format(" {}=\"#{:02x}{:02x}{:02x}\"", property, part(IM_COL32_R_SHIFT),
                                 part(IM_COL32_G_SHIFT), part(IM_COL32_B_SHIFT));
  const unsigned alpha = part(IM_COL32_A_SHIFT);
  return alpha == 255 ? text
                      : text + fmt::format(" {}-opacity=\"{:.2g}\"", property, alpha / 255.0);
}

std::string rectangle(ImVec2 min, ImVec2 max) {
  return fmt::format("<rect x=\"{:.5g}\" y=\"{:.5g}\" width=\"{:.5g}\" height=\"{:.5g}\"", min.x,
                     min.y, max.x - min.x, max.y - min.y);
}

class SvgWriter {
 public:
  void add(const PlotShape& shape) {
    if (shape.kind == Kind::line) {
      addLine(shape);
      return;
    }
    endPath();
    switch (shape.kind) {
      case Kind::line:
        break;
      case Kind::filled_rect:
        addRect(shape, paint("fill", shape.colour));
        break;
      case Kind::rect:
        addRect(shape, " fill=\"none\"" + paint("stroke", shape.colour));
        break;
      case Kind::disc:
        addCircle(shape, paint("fill", shape.colour));
        break;
      case Kind::circle:
        addCircle(shape, fmt::format(" fill=\"none\"{} stroke-width=\"{:.3g}\"",
                                     paint("stroke", shape.colour), shape.width));
        break;
      case Kind::text:
        // Another font may be wider.
        text_ += fmt::format(
            "<text x=\"{:.5g}\" y=\"{:.5g}\" textLength=\"{:.4g}\" "
            "lengthAdjust=\"spacingAndGlyphs\"{}>{}</text>\n",
            shape.from.x, shape.from.y + ImGui::GetFont()->Ascent, shape.to.x - shape.from.x,
            paint("fill", shape.colour), escapedForXml(shape.text));
        break;
      case Kind::clip:
        ++clips_;
        text_ += fmt::format(
            "<clipPath id=\"clip{0}\">{1}/></clipPath>\n"
            "<g clip-path=\"url(#clip{0})\">\n",
            clips_, rectangle(shape.from, shape.to));
        break;
      case Kind::unclip:
        text_ += "</g>\n";
        break;
    }
  }

  std::string take() {
    endPath();
    return std::move(text_);
  }

 private:
  void addLine(const PlotShape& shape) {
    const bool continues = !path_.empty() && last_.to.x == shape.from.x &&
                           last_.to.y == shape.from.y && last_.colour == shape.colour &&
                           last_.size == shape.size;
    if (!continues) {
      endPath();
      path_ = fmt::format("M{:.5g} {:.5g}", shape.from.x, shape.from.y);
    }
    path_ += fmt::format("L{:.5g} {:.5g}", shape.to.x, shape.to.y);
    last_ = shape;
  }

  void endPath() {
    if (path_.empty()) return;
    text_ += fmt::format("<path d=\"{}\" fill=\"none\"{} stroke-width=\"{:.3g}\"/>\n", path_,
                         paint("stroke", last_.colour), last_.size);
    path_.clear();
  }

  void addRect(const PlotShape& shape, const std::string& painted) {
    text_ += rectangle(shape.from, shape.to);
    if (shape.size > 0) text_ += fmt::format(" rx=\"{:.3g}\"", shape.size);
    text_ += painted + "/>\n";
  }

  void addCircle(const PlotShape& shape, const std::string& painted) {
    text_ += fmt::format("<circle cx=\"{:.5g}\" cy=\"{:.5g}\" r=\"{:.3g}\"{}/>\n", shape.from.x,
                         shape.from.y, shape.size, painted);
  }

  std::string text_;
  std::string path_;  ///< not ended yet; its last line:
  PlotShape last_;
  int clips_ = 0;
};

}  // namespace

std::string formatSvg(const std::vector<PlotShape>& shapes, ImVec2 min, ImVec2 max) {
  SvgWriter writer;
  writer.add({.kind = Kind::filled_rect,
              .from = min,
              .to = max,
              .colour = ImGui::GetColorU32(ImGuiCol_WindowBg)});
  for (const PlotShape& shape : shapes) writer.add(shape);
  const float width = max.x - min.x;
  const float height = max.y - min.y;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.5g}\" height=\"{1:.5g}\" "
      "viewBox=\"{2:.5g} {3:.5g} {0:.5g} {1:.5g}\" font-family=\"Inter, sans-serif\" "
      "xml:space=\"preserve\" font-size=\"{4:.3g}\">\n{5}</svg>\n",
      width, height, min.x, min.y, ImGui::GetFontSize(), writer.take());
}

}  // namespace broadmark
