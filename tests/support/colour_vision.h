// Simulates colour vision deficiencies and measures how well two colours can be distinguished.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "broadmark/render/colour.h"

namespace broadmark::tests {

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;

/// On linear RGB: Machado, Oliveira, Fernandes, "A Physiologically-based Model for Simulation of
/// Color Vision Deficiency" (2009), severity 1. The first has full colour vision.
struct Eye {
  const char* name;
  Matrix matrix;
};
inline constexpr std::array<Eye, 4> kEyes = {{{"all colours", {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
                                              {"protanopia",
                                               {{{0.152286, 1.052583, -0.204868},
                                                 {0.114503, 0.786281, 0.099216},
                                                 {-0.003882, -0.048116, 1.051998}}}},
                                              {"deuteranopia",
                                               {{{0.367322, 0.860646, -0.227968},
                                                 {0.280085, 0.672501, 0.047413},
                                                 {-0.011820, 0.042940, 0.968881}}}},
                                              {"tritanopia",
                                               {{{1.255528, -0.076749, -0.178779},
                                                 {-0.078411, 0.930809, 0.147602},
                                                 {0.004733, 0.691367, 0.303900}}}}}};

inline Triple times(const Matrix& matrix, const Triple& v) {
  Triple product{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t i = 0; i < 3; ++i) product[row] += matrix[row][i] * v[i];
  }
  return product;
}

/// From sRGB, each 0 to 1.
inline Triple linear(Rgb colour) {
  const auto channel = [&](int shift) {
    const double value = ((colour >> shift) & 0xFFU) / 255.0;
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  };
  return {channel(16), channel(8), channel(0)};
}

/// CIE L*a*b* of a colour as an eye sees it (D65).
inline Triple labOf(Rgb colour, const Eye& eye) {
  Triple seen = times(eye.matrix, linear(colour));
  for (double& value : seen) value = std::clamp(value, 0.0, 1.0);
  constexpr Matrix kToXyz = {{{0.4124564, 0.3575761, 0.1804375},
                              {0.2126729, 0.7151522, 0.0721750},
                              {0.0193339, 0.1191920, 0.9503041}}};
  constexpr Triple kWhite = {0.95047, 1, 1.08883};
  Triple f = times(kToXyz, seen);
  for (std::size_t i = 0; i < 3; ++i) {
    const double ratio = f[i] / kWhite[i];
    f[i] = ratio > 216.0 / 24389 ? std::cbrt(ratio) : (24389.0 / 27 * ratio + 16) / 116;
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

/// Distance in L*a*b*. Adjacent colours are distinguishable from about 2 on.
inline double differenceOf(Rgb a, Rgb b, const Eye& eye) {
  const Triple x = labOf(a, eye);
  const Triple y = labOf(b, eye);
  return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
}

/// WCAG 2: from 1 to 21; text needs 4.5.
inline double contrastOf(Rgb a, Rgb b) {
  const auto luminance = [](Rgb colour) {
    const Triple rgb = linear(colour);
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  };
  const double luminance_a = luminance(a) + 0.05;
  const double luminance_b = luminance(b) + 0.05;
  return std::max(luminance_a, luminance_b) / std::min(luminance_a, luminance_b);
}

}  // namespace broadmark::tests
