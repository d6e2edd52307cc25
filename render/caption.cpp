// Glyphs come from stb_truetype and the embedded font.
#include "caption.h"

#include <stb/stb_truetype.h>

#include <algorithm>
#include <cmath>

#include "broadmark/render/fonts.h"
#include "render_assets.h"

namespace broadmark {
namespace {

using Row = std::vector<CaptionItem>;

constexpr float kMinLetterSize = 9;  // pixels; smaller letters are illegible
constexpr int kOpaque = 255;
constexpr int kPanelAlpha = 210;  // the picture just shows through the panel

void blend(Picture& picture, int x, int y, Rgb colour, int alpha) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
  std::uint8_t* pixel = &picture.rgba[4 * (static_cast<std::size_t>(y) * picture.width + x)];
  for (int channel = 0; channel < 3; ++channel) {
    const int target = static_cast<int>((colour >> (16 - 8 * channel)) & 0xFFU);
    pixel[channel] =
        static_cast<std::uint8_t>((pixel[channel] * (255 - alpha) + target * alpha + 127) / 255);
  }
}

struct Rectangle {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

void fill(Picture& picture, const Rectangle& area, Rgb colour, int alpha) {
  for (int y = area.top; y < area.top + area.height; ++y) {
    for (int x = area.left; x < area.left + area.width; ++x) blend(picture, x, y, colour, alpha);
  }
}

/// The embedded font at a given size. All lengths are in pixels.
class Typeface {
 public:
  explicit Typeface(float size) : size_(size) {
    const auto* data = reinterpret_cast<const unsigned char*>(interfaceFont().data());
    if (stbtt_InitFont(&font_, data, stbtt_GetFontOffsetForIndex(data, 0)) == 0) {
      throw RenderError("the embedded font cannot be read");
    }
    scale_ = stbtt_ScaleForMappingEmToPixels(&font_, size);
  }

  [[nodiscard]] float size() const { return size_; }

  [[nodiscard]] float width(const std::string& text) const {
    float x = 0;
    layOut(text, [&](int, float, float advance) { x += advance; });
    return x;
  }

  void draw(Picture& picture, const std::string& text, float left, int baseline, Rgb colour) const {
    layOut(text, [&](int letter, float x, float) {
      drawLetter(picture, letter, left + x, baseline, colour);
    });
  }

 private:
  /// Calls visit(letter, x, advance) for each letter.
  template <class Visit>
  void layOut(const std::string& text, Visit visit) const {
    float x = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const int letter = static_cast<unsigned char>(text[i]);
      int advance = 0;
      int bearing = 0;
      stbtt_GetCodepointHMetrics(&font_, letter, &advance, &bearing);
      if (i + 1 < text.size()) {
        const int next = static_cast<unsigned char>(text[i + 1]);
        advance += stbtt_GetCodepointKernAdvance(&font_, letter, next);
      }
      visit(letter, x, scale_ * static_cast<float>(advance));
      x += scale_ * static_cast<float>(advance);
    }
  }

  void drawLetter(Picture& picture, int letter, float x, int baseline, Rgb colour) const {
    int width = 0;
    int height = 0;
    int left = 0;
    int top = 0;
    const float origin = std::floor(x);
    unsigned char* coverage = stbtt_GetCodepointBitmapSubpixel(
        &font_, scale_, scale_, x - origin, 0, letter, &width, &height, &left, &top);
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        blend(picture, static_cast<int>(origin) + left + column, baseline + top + row, colour,
              coverage[row * width + column]);
      }
    }
    stbtt_FreeBitmap(coverage, nullptr);  // null (a space) is allowed
  }

  stbtt_fontinfo font_{};
  float size_;
  float scale_ = 0;
};

// Lengths relative to the letter size.
float gap(const Typeface& face) { return std::round(1.2F * face.size()); }
int swatchSide(const Typeface& face) { return static_cast<int>(std::round(0.72F * face.size())); }
float swatchWidth(const Typeface& face) {
  return static_cast<float>(swatchSide(face)) + std::round(0.45F * face.size());
}

float itemWidth(const Typeface& face, const CaptionItem& item) {
  return (item.swatch ? swatchWidth(face) : 0) + face.width(item.text);
}

float rowWidth(const Typeface& face, const Row& row) {
  float width = -gap(face);
  for (const CaptionItem& item : row) width += itemWidth(face, item) + gap(face);
  return width;
}

void drawRow(Picture& picture, const Typeface& face, const Row& row, float left, int baseline) {
  for (const CaptionItem& item : row) {
    float text_left = left;
    if (item.swatch) {
      const int side = swatchSide(face);
      fill(picture, {static_cast<int>(std::round(left)), baseline - side, side, side}, *item.swatch,
           kOpaque);
      text_left += swatchWidth(face);
    }
    face.draw(picture, item.text, text_left, baseline, item.colour);
    left += itemWidth(face, item) + gap(face);
  }
}

}  // namespace

std::string_view interfaceFont() { return render_assets::Inter_Regular_otf(); }

void drawCaption(Picture& picture, const std::vector<Row>& rows, Rgb background) {
  float size =
      std::max(11.0F, std::round(static_cast<float>(std::min(picture.width, picture.height)) / 40));
  const auto widest = [&rows](const Typeface& face) {
    float width = 0;
    for (const Row& row : rows) width = std::max(width, rowWidth(face, row));
    return width;
  };
  const float margin = std::round(1.2F * size);
  const float available_width = static_cast<float>(picture.width) - 2 * margin;
  const float target = widest(Typeface(size));
  if (target > available_width) size = std::floor(size * available_width / target);
  const auto row_height = static_cast<int>(std::round(1.55F * size));
  const int height = row_height * static_cast<int>(rows.size());
  const auto left = static_cast<int>(margin);
  const int top = picture.height - left - height;
  if (!(size >= kMinLetterSize) || top < 0) return;

  const Typeface face(size);
  const int border = left / 2;
  fill(picture,
       {left - border, top - border, static_cast<int>(widest(face)) + 2 * border,
        height + 2 * border},
       background, kPanelAlpha);
  int baseline = top + static_cast<int>(std::round(1.15F * size));
  for (const Row& row : rows) {
    drawRow(picture, face, row, margin, baseline);
    baseline += row_height;
  }
}

}  // namespace broadmark
