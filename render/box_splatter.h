// The software renderer. Without a GPU it draws many small boxes several times as fast as an
// OpenGL that runs on the processor.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/execution.h"
#include "primitive_renderer.h"
#include "splat_kernels.h"

namespace broadmark {

/// Draws solid boxes on the processor; they look like those of BoxRenderer. The picture stays until
/// the next draw(). It is the same for every number of threads and every instruction set.
class BoxSplatter {
 public:
  /// `team` does the drawing and must outlive this.
  explicit BoxSplatter(ThreadTeam& team, Isa isa = bestIsa());

  /// Boxes in view space (see boxPrimitive()) on a background of the viewpoint's haze. Each side of
  /// the picture: 1 to kLargestSplat pixels.
  void draw(std::span<const Primitive> boxes, const Viewpoint& viewpoint);

  /// RGBA8 in memory order, rows from bottom to top as in OpenGL.
  [[nodiscard]] std::span<const std::uint32_t> colours() const { return colours_; }
  /// As in OpenGL's depth buffer, 0 to 1; 1 where there is no box.
  [[nodiscard]] std::span<const float> depths() const { return depths_; }

  static constexpr int kLargestSplat = 16384;

 private:
  /// Buffers of one worker. Boxes are listed by the bands that they touch.
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
