// Compares pictures, with a tolerance for differences between drivers and processors.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "broadmark/render/fonts.h"
#include "broadmark/render/picture.h"

namespace broadmark::tests {

/// Maximum of differing pixels per thousand, in a picture of a scene.
inline constexpr double kMaxDifferencePerMille = 1;

/// Whether two pictures are the same: at most `max` of a thousand pixels differ by more than 8/255
/// in any channel. Otherwise writes a picture of the differences (red on the faded first one) to
/// the tests' temporary directory, as NAME-difference.png.
inline testing::AssertionResult looksLike(const Picture& actual, const Picture& expected,
                                          const std::string& name,
                                          double max = kMaxDifferencePerMille) {
  constexpr int kTolerance = 8;
  if (actual.width != expected.width || actual.height != expected.height) {
    return testing::AssertionFailure()
           << name << " is " << actual.width << " x " << actual.height << ", expected "
           << expected.width << " x " << expected.height;
  }
  Picture difference = actual;
  std::size_t wrong = 0;
  for (std::size_t pixel = 0; pixel < actual.rgba.size(); pixel += 4) {
    bool differs = false;
    for (std::size_t i = pixel; i < pixel + 4; ++i) {
      differs = differs || std::abs(actual.rgba[i] - expected.rgba[i]) > kTolerance;
      difference.rgba[i] = static_cast<std::uint8_t>(191 + actual.rgba[i] / 4);
    }
    if (!differs) continue;
    ++wrong;
    difference.rgba[pixel] = 255;
    difference.rgba[pixel + 1] = difference.rgba[pixel + 2] = 0;
  }
  const std::size_t pixels = actual.rgba.size() / 4;
  if (1000 * static_cast<double>(wrong) <= max * static_cast<double>(pixels))
    return testing::AssertionSuccess();
  const auto path = std::filesystem::path(testing::TempDir()) / (name + "-difference.png");
  writePng(path, difference);
  return testing::AssertionFailure()
         << name << ": " << wrong << " of " << pixels << " pixels differ, see " << path.string();
}

/// Whether letters look as in the golden pictures, which have the Inter of Debian 12 (3.19).
inline bool hasGoldenLetters() { return interfaceFont().size() == 258'992; }

/// Compares with a picture in the source tree. With BROADMARK_UPDATE_GOLDEN=1 in the environment,
/// writes that picture instead.
inline testing::AssertionResult looksLikeGolden(const Picture& actual,
                                                const std::filesystem::path& golden,
                                                double max = kMaxDifferencePerMille) {
  const char* update = std::getenv("BROADMARK_UPDATE_GOLDEN");
  if (update != nullptr && std::string(update) == "1") {
    writePng(golden, actual);
    return testing::AssertionSuccess();
  }
  return looksLike(actual, readPng(golden), golden.stem().string(), max);
}

}  // namespace broadmark::tests
