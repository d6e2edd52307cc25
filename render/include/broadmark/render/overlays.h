// Overlays: lines of pairs, and the structure of an algorithm.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "broadmark/pair.h"
#include "broadmark/recorded_drawing.h"
#include "broadmark/render/colouring.h"
#include "broadmark/render/scene_view.h"

namespace broadmark {

/// Lines and boxes for SceneView.
struct Overlay {
  std::vector<SceneLine> lines;
  std::vector<SceneWireBox> boxes;
  std::size_t dropped = 0;          ///< number of lines and boxes beyond the limit
  std::vector<LegendEntry> legend;  ///< of boxes coloured by population; counts boxes
};

struct PairLineStyle {
  Rgb colour = 0;
  float width = 1.5F;
  OcclusionStyle behind = OcclusionStyle::faint;
  std::size_t max_lines = 50'000;
};

/// A line between the centres of each pair. With `only`: only pairs with one of these bodies. Omits
/// pairs with absent or nonexistent bodies.
Overlay pairLines(std::span<const Aabb> boxes, PairRuns pairs, const PairLineStyle& style,
                  std::optional<std::span<const std::uint32_t>> only = {});

struct StructureStyle {
  int first_level = 0;
  int last_level = std::numeric_limits<int>::max();
  std::optional<Aabb> near;        ///< only objects that overlap this box
  std::size_t max_items = 20'000;  ///< limit of boxes, and of lines
  bool by_population = false;      ///< colours boxes with a population by a scale
  bool dark = false;               ///< whether the background is dark
};

/// The visible part of an algorithm's structure. Lines have no level. By population, the fullest
/// boxes are drawn over others, and emptier boxes are omitted above the maximum.
Overlay structureOverlay(const RecordedDrawing& drawing, const StructureStyle& style);

bool hasPopulations(const RecordedDrawing& drawing);

/// The greatest level of a drawing's boxes; 0 without any.
int maxLevel(const RecordedDrawing& drawing);

}  // namespace broadmark
