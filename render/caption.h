// Text and swatches drawn straight into a finished picture: the same on every driver.
#pragma once

#include <string>
#include <vector>

#include "broadmark/debug_draw.h"
#include "broadmark/render/picture.h"

namespace broadmark {

/// A piece of a caption: a text (printable ASCII) in one colour, perhaps behind a colour swatch.
struct CaptionItem {
  std::string text;
  Rgb colour = 0;
  bool has_swatch = false;
  Rgb swatch = 0;
};

/// Rows of items on a panel of `background` in the picture's lower left corner. The letters' size
/// follows the picture's; rows that are too long for it become smaller, down to the legible; if
/// that does not do, the whole caption is left out.
void drawCaption(Picture& picture, const std::vector<std::vector<CaptionItem>>& rows,
                 Rgb background);

}  // namespace broadmark
