// The software renderer. It draws many small boxes and lines several times as fast as OpenGL on the
// CPU.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/execution.h"
#include "broadmark/range.h"
#include "scene_primitives.h"
#include "splat_kernels.h"

namespace broadmark {

/// Sorts items into bands of rows, so that workers can draw bands in parallel. Stores the indices
/// of the items that overlap each band, in ascending order for any number of workers.
class BandLists {
 public:
  /// Small enough for a core's cache, large enough for few items to overlap two bands.
  static constexpr int kRows = 32;

  void reset(std::size_t items, int bands, int workers) {
    rectangles_.resize(items);
    lists_.resize(static_cast<std::size_t>(workers));
    for (auto& by_band : lists_) {
      by_band.resize(static_cast<std::size_t>(bands));
      for (std::vector<std::uint32_t>& list : by_band) list.clear();
    }
  }

  /// Sorts a worker's share of the items; project(first, last, rectangles) fills their rectangles.
  template <class Project>
  void fill(int worker, const Project& project) {
    auto& by_band = lists_[static_cast<std::size_t>(worker)];
    const auto [begin, end] = share(rectangles_.size(), static_cast<int>(lists_.size()), worker);
    // In blocks, so that the rectangles are still in the cache when they are sorted into bands.
    constexpr std::size_t kBlock = 1024;
    for (std::size_t first = begin; first < end; first += kBlock) {
      const std::size_t last = std::min(first + kBlock, end);
      project(first, last, rectangles_.data());
      for (std::size_t item = first; item < last; ++item) {
        const PixelRectangle& rectangle = rectangles_[item];
        if (rectangle.left > rectangle.right) continue;
        for (int band = rectangle.bottom / kRows; band <= rectangle.top / kRows; ++band) {
          by_band[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(item));
        }
      }
    }
  }

  /// Calls visit(items, rectangles) for each part of a band's items, in order.
  template <class Visit>
  void forEach(int band, const Visit& visit) const {
    for (const auto& by_band : lists_) {
      visit(std::span(by_band[static_cast<std::size_t>(band)]), rectangles_.data());
    }
  }

 private:
  std::vector<PixelRectangle> rectangles_;
  std::vector<std::vector<std::vector<std::uint32_t>>> lists_;  ///< by worker and band
};

/// Draws a scene on the CPU, with the appearance of the OpenGL renderer. The picture is valid until
/// the next draw(), and is the same for every number of threads and every instruction set.
class SoftwareRasterizer {
 public:
  /// `team` must outlive this object.
  explicit SoftwareRasterizer(ThreadTeam& team, Isa isa = bestIsa());

  /// The background is the viewpoint's haze. Each side of the picture has 1 to 16384 pixels.
  void draw(const ScenePrimitives& scene, const Viewpoint& viewpoint);

  /// RGBA8 in memory order, rows from bottom to top as in OpenGL.
  [[nodiscard]] std::span<const std::uint32_t> colours() const { return colours_; }

 private:
  struct BoxLayer {
    std::span<const SplatBox> boxes;
    BandLists lists;
  };
  struct StripLayer {
    float opacity = 1;
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
  void setPrimitives(const ScenePrimitives& scene, int bands);
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
  BoxLayer glass_;
  std::array<StripLayer, ScenePrimitives::layers> strips_;
  std::atomic<int> next_band_{0};
  std::vector<std::uint32_t> colours_;
};

}  // namespace broadmark
