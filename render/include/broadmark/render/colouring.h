// The colour modes of bodies, from which the user interface and its legend are generated. The
// colours are distinguishable for colour-blind people, on light and dark backgrounds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/pair.h"
#include "broadmark/render/colour.h"

namespace broadmark {

/// The input of a mode, not owned. Pairs may name nonexistent bodies.
struct ColouringInput {
  std::span<const Aabb> boxes;              ///< empty for absent bodies
  std::span<const Aabb> previous;           ///< of the previous frame, or empty
  std::span<const std::uint32_t> overlaps;  ///< by body: overlapCounts()
  /// By body, as reported to DebugDraw::tests(); empty if not reported.
  std::span<const std::uint32_t> tests;
  std::span<const std::uint8_t> layers;  ///< CollisionFilter::layers()
  std::span<const Pair> missed;
  std::span<const Pair> false_pairs;
  /// The difference of two answers, or null. `overlaps` then counts the pairs of both answers.
  struct Comparison {
    std::span<const Pair> first_only;
    std::span<const Pair> second_only;
  };
  const Comparison* comparison = nullptr;
  bool dark = false;  ///< whether the background is dark
};

struct LegendEntry {
  std::string label;
  Rgb swatch = 0;
  std::uint64_t count = 0;  ///< present bodies

  friend bool operator==(const LegendEntry&, const LegendEntry&) = default;
};

struct Colouring {
  std::vector<Rgb> colours;           ///< by body
  std::vector<std::uint8_t> classes;  ///< by body: an index into the legend
  std::vector<LegendEntry> legend;
};

struct ColourMode {
  std::string_view id;     ///< "overlapping"
  std::string_view title;  ///< "Overlapping"
  std::string_view help;   ///< one line
  /// Replaces the content of `colouring`, reusing its memory. O(boxes + pairs).
  void (*colour)(const ColouringInput& input, Colouring& colouring);
  bool of_answer = false;  ///< whether the classes depend only on an answer's pairs
  bool of_tests = false;   ///< whether the mode reads `tests`
};

/// All modes; the first is the default.
std::span<const ColourMode> colourModes();
/// The index of the mode with this id, which must exist.
std::size_t colourModeIndex(std::string_view id);

}  // namespace broadmark
