// The software renderer: on a processor without a GPU it draws many small boxes several times as
// fast as OpenGL's own emulation does.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/execution.h"
#include "broadmark/render/primitive_renderer.h"
#include "broadmark/render/splat_kernels.h"

namespace broadmark {

/// Draws solid boxes that look as those of BoxRenderer do, on the processor. The picture stays
/// until the next draw(); it is the same for every number of threads and every instruction set.
class BoxSplatter {
 public:
  /// `team` draws, and outlives this.
  explicit BoxSplatter(ThreadTeam& team, Isa isa = bestIsa());

  /// Boxes in view space (see boxPrimitive()), before a background of the viewpoint's haze. Sides
  /// of the picture: 1 to kLargestSplat pixels.
  void draw(std::span<const Primitive> boxes, const Viewpoint& viewpoint);

  /// RGBA8 in memory order, rows from bottom to top as OpenGL has them.
  [[nodiscard]] std::span<const std::uint32_t> colours() const { return colours_; }
  /// What OpenGL would have in its depth buffer, 0 to 1; 1 where there is no box.
  [[nodiscard]] std::span<const float> depths() const { return depths_; }

  static constexpr int kLargestSplat = 16384;

 private:
  /// What one worker has at hand. Boxes are listed by the bands that they touch.
  struct Worker {
    std::vector<std::vector<std::uint32_t>> boxes_by_band;
    std::vector<float> depths;
    std::vector<std::uint32_t> foremost;
  };
  void project(const SplatView& view, std::span<const SplatBox> boxes, int worker);
  void drawBand(const SplatView& view, std::span<const SplatBox> boxes, int number, Worker& worker);

  const SplatKernels* kernels_;
  ThreadTeam* team_;
  std::vector<Worker> workers_;
  std::vector<PixelRectangle> rectangles_;
  std::atomic<int> next_band_{0};
  std::vector<std::uint32_t> colours_;
  std::vector<float> depths_;
};

}  // namespace broadmark
