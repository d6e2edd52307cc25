// Text and swatches, drawn into a finished picture by the processor: the same on every driver.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "broadmark/render/colour.h"
#include "broadmark/render/picture.h"

namespace broadmark {

/// A piece of a caption: printable ASCII in one colour, after a colour swatch if there is one.
struct CaptionItem {
  std::string text;
  Rgb colour = 0;
  std::optional<Rgb> swatch = std::nullopt;
};

/// Rows of items on a panel of `background` in the picture's lower left corner. The size of the
/// letters follows the picture's. Rows that are too long are drawn smaller; if they would become
/// illegible, the whole caption is left out.
void drawCaption(Picture& picture, const std::vector<std::vector<CaptionItem>>& rows,
                 Rgb background);

}  // namespace broadmark
