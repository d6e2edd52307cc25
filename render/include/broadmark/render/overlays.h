// What is drawn over the bodies: lines of pairs, and the structure of an algorithm.
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
  std::size_t left_out = 0;         ///< number of lines and boxes beyond the limit
  std::vector<LegendEntry> legend;  ///< of boxes coloured by population; their counts are boxes
};

struct PairLineStyle {
  Rgb colour = 0;
  float width = 1.5F;
  OcclusionStyle behind = OcclusionStyle::faint;
  std::size_t most = 50'000;  ///< lines
};

/// A line from middle to middle for each pair; with `only`, for each pair with one of these bodies.
/// Pairs of bodies that do not exist, or are absent, are left out.
Overlay pairLines(std::span<const Aabb> boxes, PairRuns pairs, const PairLineStyle& style,
                  std::optional<std::span<const std::uint32_t>> only = {});

struct StructureLook {
  int first_level = 0;
  int last_level = std::numeric_limits<int>::max();
  std::optional<Aabb> near;    ///< only what touches this box
  std::size_t most = 20'000;   ///< boxes, and as many lines
  bool by_population = false;  ///< boxes that tell theirs have colours of a scale
  bool dark = false;           ///< the background
};

/// The part of an algorithm's structure that is to be seen. Lines have no level. By population, the
/// fullest boxes are kept where there are too many, and drawn over others.
Overlay structureOverlay(const RecordedDrawing& drawing, const StructureLook& look);

/// Whether any box tells its population.
bool tellsPopulations(const RecordedDrawing& drawing);

/// The greatest level of a drawing's boxes; 0 without any.
int deepestLevel(const RecordedDrawing& drawing);

}  // namespace broadmark
