// The software renderer. Without a GPU it draws many small boxes and lines several times as fast as
// an OpenGL that runs on the processor.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "band_lists.h"
#include "broadmark/execution.h"
#include "scene_primitives.h"
#include "splat_kernels.h"

namespace broadmark {

/// Draws a scene on the processor; it looks as if OpenGL had drawn it. The picture stays until the
/// next draw(). It is the same for every number of threads and every instruction set.
class Splatter {
 public:
  /// `team` does the drawing and must outlive this.
  explicit Splatter(ThreadTeam& team, Isa isa = bestIsa());

  /// On a background of the viewpoint's haze. Each side of the picture: 1 to kLargestSplat pixels.
  void draw(const ScenePrimitives& scene, const Viewpoint& viewpoint);

  /// RGBA8 in memory order, rows from bottom to top as in OpenGL.
  [[nodiscard]] std::span<const std::uint32_t> colours() const { return colours_; }

  static constexpr int kLargestSplat = 16384;

 private:
  struct BoxLayer {
    std::span<const SplatBox> boxes;
    BandLists lists;
  };
  struct StripLayer {
    float opacity_behind = 0;
    bool where_no_box_is = false;
    std::span<const SplatLine> lines;
    std::vector<SplatStrip> strips;
    BandLists lists;
  };
  /// Buffers for a band.
  struct Worker {
    std::vector<float> depths;
    std::vector<std::uint32_t> foremost;
    std::vector<std::uint32_t> colours;
  };
  void take(const ScenePrimitives& scene, int bands);
  void project(const SplatView& view, int worker);
  void drawBand(const SplatView& view, std::uint32_t background, int number, Worker& worker);
  void drawBoxes(const SplatView& view, const BoxLayer& layer, int number,
                 const SplatBand& band) const;
  void drawLines(const StripLayer& layer, int number, const SplatBand& band) const;

  const SplatKernels* kernels_;
  ThreadTeam* team_;
  std::vector<Worker> workers_;
  BoxLayer floor_;
  BoxLayer bodies_;
  std::array<StripLayer, ScenePrimitives::layers> strips_;
  std::atomic<int> next_band_{0};
  std::vector<std::uint32_t> colours_;
};

}  // namespace broadmark
