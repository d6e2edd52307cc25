// Sorts what is drawn into bands of rows, so that workers can draw bands at the same time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/range.h"
#include "splat_kernels.h"

namespace broadmark {

/// For each band the positions of the items that touch it, ascending for any number of workers.
class BandLists {
 public:
  /// Small enough that a band stays in a core's cache, large enough that few items lie in two.
  static constexpr int kRows = 32;

  void reset(std::size_t items, int bands, int workers) {
    rectangles_.resize(items);
    lists_.resize(static_cast<std::size_t>(workers));
    for (auto& by_band : lists_) {
      by_band.resize(static_cast<std::size_t>(bands));
      for (std::vector<std::uint32_t>& list : by_band) list.clear();
    }
  }

  /// A worker's share of the items: project(first, last, rectangles) fills their rectangles.
  template <class Project>
  void fill(int worker, const Project& project) {
    auto& by_band = lists_[static_cast<std::size_t>(worker)];
    const auto [begin, end] = share(rectangles_.size(), static_cast<int>(lists_.size()), worker);
    // In pieces: the rectangles are still in the cache when they are sorted into bands.
    constexpr std::size_t kPiece = 1024;
    for (std::size_t first = begin; first < end; first += kPiece) {
      const std::size_t last = std::min(first + kPiece, end);
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

  /// Calls draw(items, rectangles) for some of a band's items after the others.
  template <class Draw>
  void forEach(int band, const Draw& draw) const {
    for (const auto& by_band : lists_) {
      draw(std::span(by_band[static_cast<std::size_t>(band)]), rectangles_.data());
    }
  }

 private:
  std::vector<PixelRectangle> rectangles_;
  std::vector<std::vector<std::vector<std::uint32_t>>> lists_;  ///< by worker and band
};

}  // namespace broadmark
