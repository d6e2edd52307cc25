// One colour per algorithm, the same in plots and tables.
#pragma once

#include <array>

#include "broadmark/debug_draw.h"

namespace broadmark {

/// Of the lane with this number. Eight colours that colour-blind people can tell apart and that can
/// be read as text, then they repeat.
constexpr Rgb curveColour(int lane, bool dark) {
  constexpr std::array<Rgb, 8> kOnDark = {0x3EB4FF, 0xDDA930, 0xB1F6CA, 0xFA8A7B,
                                          0xD6FD47, 0xACA7B8, 0xFFE597, 0x88FAFF};
  constexpr std::array<Rgb, 8> kOnLight = {0x07669E, 0x955400, 0x6025AB, 0x576362,
                                           0x630000, 0x022B62, 0x715F39, 0x51182D};
  const auto index = static_cast<std::size_t>(lane > 0 ? lane - 1 : 0) % kOnDark.size();
  return dark ? kOnDark[index] : kOnLight[index];
}

}  // namespace broadmark
