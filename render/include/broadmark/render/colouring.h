// What the bodies' colours tell: one mode of a list, which the user interface and its legend are
// made from. Colours are told apart by colour-blind people and on light and dark backgrounds.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/debug_draw.h"
#include "broadmark/pair.h"

namespace broadmark {

/// What colours are made from, borrowed. Pairs may name bodies that do not exist.
struct ColouringInput {
  std::span<const Aabb> boxes;
  std::span<const Aabb> previous;           ///< of the frame before; empty when there is none
  std::span<const std::uint32_t> overlaps;  ///< of each body: see overlapCounts()
  std::span<const Pair> missed;
  std::span<const Pair> extra;
  bool dark = false;  ///< the background
};

struct LegendEntry {
  std::string label;
  Rgb swatch = 0;
  std::uint64_t count = 0;  ///< of bodies

  friend bool operator==(const LegendEntry&, const LegendEntry&) = default;
};

struct Colouring {
  std::vector<Rgb> colours;  ///< one for each box
  std::vector<LegendEntry> legend;
};

struct ColourMode {
  std::string_view id;     ///< "overlapping"
  std::string_view title;  ///< "Overlapping"
  std::string_view help;   ///< one line
  /// Fills the colouring anew; its memory is used again. O(boxes + pairs).
  void (*colour)(const ColouringInput& input, Colouring& colouring);
};

/// All modes; the first is the default.
std::span<const ColourMode> colourModes();

}  // namespace broadmark
