// What a scene is like: how dense, how crowded, how much of it moves, how large its bodies are.
// These decide which broad phase suits it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/recording.h"

namespace broadmark {

/// Figures of one frame. The extent of a body is the longest edge of its box. With no bodies, all
/// are 0.
struct FrameStatistics {
  std::uint32_t frame = 0;
  double density = 0;  ///< sum of all boxes' volumes / volume of the world (0 if that is 0)
  double pairs_per_body = 0;
  /// Share of the bodies whose box differs from that in the frame before; frame 0 has none before.
  std::optional<double> moving_share;
  std::uint64_t outside = 0;  ///< bodies whose centre is outside the world
  double min_extent = 0;
  double median_extent = 0;
  double max_extent = 0;
};

/// Of `frame`, `before` being the boxes of the frame before it (as many; or none).
FrameStatistics frameStatistics(const SceneInfo&, const Frame& frame,
                                std::span<const Aabb> before = {});

/// Figures of successive frames together: means over the frames, unless stated otherwise.
struct RangeStatistics {
  std::uint32_t first = 0;
  std::uint32_t last = 0;  ///< inclusive
  double density = 0;
  double pairs_per_body = 0;
  std::optional<double> moving_share;  ///< of the frames that have one
  std::uint64_t max_outside = 0;       ///< most bodies outside in one frame
  double min_extent = 0;               ///< of all frames
  double median_extent = 0;            ///< the median of the frames' medians
  double max_extent = 0;               ///< of all frames

  /// Extent of the largest body divided by that of the smallest; nothing if the latter is 0.
  [[nodiscard]] std::optional<double> sizeRatio() const;
};

/// Of at least one frame.
RangeStatistics rangeStatistics(std::span<const FrameStatistics> frames);

/// A whole scene.
struct SceneDescription {
  RangeStatistics initial;  ///< frame 0
  /// Frames 1…F in successive parts whose lengths differ by 1 at most; none if F = 0.
  std::vector<RangeStatistics> parts;
  std::optional<RangeStatistics> overall;  ///< frames 1…F
};

/// Goes through all frames, with the memory of two of them. Frames 1…F are shown in `parts` parts,
/// or one for each frame if there are fewer. Nothing if `progress` stopped it.
std::optional<SceneDescription> describe(FrameSource&, int parts = 10,
                                         const FrameProgress& progress = {});

/// A description with what it describes.
struct DescribedRecording {
  std::string path;
  std::string hash;
  SceneInfo scene;
  SceneDescription description;
};

/// As JSON ("schema": "broadmark-descriptions/1").
std::string formatDescriptions(std::span<const DescribedRecording>);

}  // namespace broadmark
