// Colours as numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace broadmark {

using Rgb = std::uint32_t;  ///< 0xRRGGBB

/// Red, green and blue, each 0 to 255.
constexpr std::array<std::uint32_t, 3> channels(Rgb colour) {
  return {(colour >> 16) & 0xFFU, (colour >> 8) & 0xFFU, colour & 0xFFU};
}

/// Red, green and blue, each 0 to 1.
constexpr std::array<float, 3> components(Rgb colour) {
  const std::array<std::uint32_t, 3> all = channels(colour);
  return {static_cast<float>(all[0]) / 255, static_cast<float>(all[1]) / 255,
          static_cast<float>(all[2]) / 255};
}

/// Interpolates each channel from a (part 0) to b (part 1).
constexpr Rgb mixed(Rgb a, Rgb b, float part) {
  const std::array<std::uint32_t, 3> from = channels(a);
  const std::array<std::uint32_t, 3> to = channels(b);
  Rgb colour = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto start = static_cast<float>(from[i]);
    const float value = start + part * (static_cast<float>(to[i]) - start);
    // std::lround() is not constexpr.
    colour = colour << 8 | static_cast<Rgb>(value + 0.5F);  // NOLINT(bugprone-incorrect-roundings)
  }
  return colour;
}

}  // namespace broadmark
