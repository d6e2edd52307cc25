// One colour per algorithm, the same in plots and tables.
#pragma once

#include <array>

#include "broadmark/debug_draw.h"

namespace broadmark {

/// Of the lane with this number. Eight hues that colour-blind people can tell apart (after Okabe
/// and Ito), then they repeat.
constexpr Rgb curveColour(int lane, bool dark) {
  constexpr std::array<Rgb, 8> kDark = {0x56B4E9, 0xE69F00, 0x2FC08F, 0xF28AC0,
                                        0xF0E442, 0xE8703A, 0x8AA4FF, 0xC9CED6};
  constexpr std::array<Rgb, 8> kLight = {0x0072B2, 0xB87A00, 0x008A63, 0xB3548A,
                                         0x8F8500, 0xC24F00, 0x4B5FD0, 0x4A525C};
  const auto index = static_cast<std::size_t>(lane > 0 ? lane - 1 : 0) % kDark.size();
  return dark ? kDark[index] : kLight[index];
}

}  // namespace broadmark
