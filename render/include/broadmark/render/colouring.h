// The list of colour modes: what the colours of bodies mean. The user interface and its legend are
// made from it. Colour-blind people can tell the colours apart, on light and dark backgrounds.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/pair.h"
#include "broadmark/render/colour.h"

namespace broadmark {

/// What a mode reads, borrowed. Pairs may name bodies that do not exist.
struct ColouringInput {
  std::span<const Aabb> boxes;              ///< empty: absent
  std::span<const Aabb> previous;           ///< of the previous frame; empty without one
  std::span<const std::uint32_t> overlaps;  ///< of each body: see overlapCounts()
  /// Of each body: as DebugDraw::tests(); empty: not told.
  std::span<const std::uint32_t> tests;
  std::span<const std::uint8_t> layers;  ///< as CollisionFilter::layers()
  std::span<const Pair> missed;
  std::span<const Pair> false_pairs;
  /// What tells two answers apart; null: there is only one. `overlaps` is of either.
  struct Comparison {
    std::span<const Pair> first_only;
    std::span<const Pair> second_only;
  };
  const Comparison* comparison = nullptr;
  bool dark = false;  ///< the background
};

struct LegendEntry {
  std::string label;
  Rgb swatch = 0;
  std::uint64_t count = 0;  ///< bodies that are present

  friend bool operator==(const LegendEntry&, const LegendEntry&) = default;
};

struct Colouring {
  std::vector<Rgb> colours;           ///< one for each box
  std::vector<std::uint8_t> classes;  ///< likewise: which entry of the legend
  std::vector<LegendEntry> legend;
};

struct ColourMode {
  std::string_view id;     ///< "overlapping"
  std::string_view title;  ///< "Overlapping"
  std::string_view help;   ///< one line
  /// Replaces the content of `colouring`; its memory is reused. O(boxes + pairs).
  void (*colour)(const ColouringInput& input, Colouring& colouring);
  bool of_answer = false;  ///< whether the classes follow from the pairs of an answer alone
  bool of_tests = false;   ///< whether `tests` are read
};

/// All modes; the first is the default.
std::span<const ColourMode> colourModes();

}  // namespace broadmark
