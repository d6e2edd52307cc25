// Properties of a scene: density, changes, body sizes and collision filter. They determine which
// broad phase suits it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/recordings/recording.h"

namespace broadmark {

/// Differences from the frame before, in bodies.
struct Changes {
  double appeared = 0;
  double vanished = 0;
  double changed = 0;  ///< appeared, vanished and moved
};

/// The changes between two frames of the same scene.
Changes changesBetween(std::span<const Aabb> before, std::span<const Aabb> boxes);

/// Statistics of the bodies present in a frame. The extent of a body is the longest edge of its
/// box. Without bodies, all are 0.
struct FrameStatistics {
  std::uint32_t frame = 0;
  std::uint32_t bodies = 0;
  double density = 0;  ///< sum of all boxes' volumes / volume of the world; 0 if the latter is 0
  double pairs_per_body = 0;
  std::optional<Changes> changes;  ///< nullopt for frame 0
  /// The fraction of changed boxes among bodies also present in the frame before. nullopt if there
  /// are none.
  std::optional<double> moving_share;
  std::uint64_t outside = 0;  ///< bodies with their centre outside the world
  double min_extent = 0;
  double median_extent = 0;
  double max_extent = 0;
};

/// The statistics of a frame with `pairs` pairs. `before`: the boxes of the frame before, or empty.
FrameStatistics frameStatistics(const SceneInfo&, const Frame& frame, std::span<const Aabb> before,
                                std::size_t pairs);

/// Aggregates over successive frames: means, unless stated otherwise.
struct RangeStatistics {
  std::uint32_t first = 0;
  std::uint32_t last = 0;  ///< inclusive
  std::uint32_t min_bodies = 0;
  double mean_bodies = 0;
  std::uint32_t max_bodies = 0;
  double density = 0;
  double pairs_per_body = 0;
  std::optional<Changes> changes;      ///< over the frames with a value
  std::optional<double> moving_share;  ///< over the frames with a value
  std::uint64_t max_outside = 0;       ///< maximum over the frames
  double min_extent = 0;               ///< over all frames
  double median_extent = 0;            ///< the median of the frames' medians
  double max_extent = 0;               ///< over all frames

  /// Extent of the largest body divided by that of the smallest; nullopt if the latter is 0.
  [[nodiscard]] std::optional<double> sizeRatio() const;
};

/// Requires at least one frame.
RangeStatistics rangeStatistics(std::span<const FrameStatistics> frames);

struct FilterStatistics {
  struct Layer {
    std::size_t layer = 0;
    double bodies = 0;  ///< present; mean per frame
  };
  /// Two colliding layers, or one that collides with itself.
  struct LayerPair {
    std::size_t a = 0;
    std::size_t b = 0;  ///< >= a
    double pairs = 0;   ///< mean per frame
  };
  std::vector<Layer> layers;           ///< layers with bodies in some frame
  std::vector<LayerPair> layer_pairs;  ///< all pairs of these layers that collide
  std::uint32_t worlds = 1;
  std::uint32_t largest_world = 0;  ///< its number of bodies, present or not
  std::uint32_t tagged = 0;         ///< bodies with tags in the initial pose
  /// Bodies with a new layer or new tags; mean per frame; nullopt if the filter does not change.
  std::optional<double> changed = {};
};

struct SceneDescription {
  RangeStatistics initial;  ///< frame 0
  /// Frames 1…F in successive parts with lengths that differ by at most 1; none if F = 0.
  std::vector<RangeStatistics> parts;
  std::optional<RangeStatistics> overall;  ///< frames 1…F
  /// Over frames 1…F, or frame 0 if there is no other; nullopt if every pair is wanted.
  std::optional<FilterStatistics> filter = {};
};

/// Reads all frames, with memory for two of them. Frames 1…F are divided into `parts` parts, or
/// into single frames if there are fewer. Returns nullopt if `progress` stopped it.
std::optional<SceneDescription> describe(FrameSource&, int parts = 10,
                                         const FrameProgress& progress = {});

struct DescribedRecording {
  std::string path;
  std::string hash;
  SceneInfo scene;
  SceneDescription description;
};

/// As JSON ("schema": "broadmark-descriptions/1"). Changes and filter are omitted for scenes
/// without them.
std::string formatDescriptions(std::span<const DescribedRecording>);

}  // namespace broadmark
