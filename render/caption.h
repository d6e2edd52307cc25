// Text and swatches, drawn into a finished picture on the CPU, and equal with every driver.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "broadmark/render/colour.h"
#include "broadmark/render/picture.h"

namespace broadmark {

/// An item of a caption: an optional colour swatch, and printable ASCII in a colour.
struct CaptionItem {
  std::string text;
  Rgb colour = 0;
  std::optional<Rgb> swatch = std::nullopt;
};

/// Draws rows of items on a panel of `background` in the picture's lower left corner. The letter
/// size scales with the picture, and is reduced if rows are too long. The caption is omitted if it
/// would be illegible.
void drawCaption(Picture& picture, const std::vector<std::vector<CaptionItem>>& rows,
                 Rgb background);

}  // namespace broadmark
