// The margin of candidate pairs: how far bodies move in a frame, and for how many frames candidates
// would serve. Nothing is timed, so decisions are deterministic.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "broadmark/aabb.h"
#include "sample.h"
#include "tide/cost_model.h"

namespace broadmark::tide {

class MarginPolicy {
 public:
  MarginPolicy() = default;
  /// `max_margin`: as a share of the mean edge; 0: never any candidates.
  explicit MarginPolicy(double max_margin) : max_margin_(max_margin) {}

  /// To be called in frames without candidates. Returns the margin of candidates that would pay, or
  /// 0.
  float marginToStart(std::span<const Aabb> boxes, std::size_t moves, const CostModel& costs) {
    if (wait_ > 0) --wait_;
    const double candidates = kGrowth * costs.pairs();
    if (wait_ > 0 || max_margin_ == 0 || !costs.candidatesPay(moves, candidates, kFrames)) {
      sample_.clear();
      return 0;
    }
    const bool is_first = sample_.empty();
    speed_ = observedSpeed(boxes);
    if (is_first) return 0;
    const float margin = chosen(moves, candidates, costs);
    frames_ = 0;
    if (margin == 0) wait_ = kFrames << std::min(failures_++, kMaxIdle);
    return margin;
  }

  /// To be called when a body has left its fat box. Returns the margin of new candidates, or 0.
  float marginToContinue(std::size_t moves, std::size_t candidates, const CostModel& costs) {
    speed_ = margin_ / std::max(1.0, static_cast<double>(frames_));
    if (frames_ > kFrames / 2) failures_ = 0;
    const float margin = chosen(moves, static_cast<double>(candidates), costs);
    frames_ = 1;
    if (margin == 0) wait_ = kFrames << std::min(failures_++, kMaxFailures);
    return margin;
  }

  /// To be called in each frame that the candidates serve, but for that of marginToContinue().
  void count() { ++frames_; }

 private:
  static constexpr std::size_t kSample = 256;
  static constexpr std::uint32_t kFrames = 16;  ///< that candidates should serve
  static constexpr double kGrowth = 1.5;        ///< candidates for each pair
  static constexpr std::uint32_t kMaxFailures = 8;
  static constexpr std::uint32_t kMaxIdle = 2;  ///< while candidates were not tried

  /// The largest step of a bound since the last call, in a sample that also gives the mean edge;
  /// 0 if none of its bodies moved.
  double observedSpeed(std::span<const Aabb> boxes) {
    const std::size_t size = std::min(kSample, sampleSize(boxes.size()));
    sample_.resize(size, kEmptyBox);
    double speed = 0;
    double edges = 0;
    std::size_t present = 0;
    for (std::size_t k = 0; k < size; ++k) {
      const Aabb& box = boxes[sampleIndex(k, size, boxes.size())];
      const Aabb before = std::exchange(sample_[k], box);
      if (isEmpty(box) || isEmpty(before)) continue;
      ++present;
      for (int axis = 0; axis < 3; ++axis) {
        edges += double{box.max[axis]} - double{box.min[axis]};
        speed = std::max({speed, std::abs(double{box.min[axis]} - double{before.min[axis]}),
                          std::abs(double{box.max[axis]} - double{before.max[axis]})});
      }
    }
    mean_edge_ = present > 0 ? edges / (3.0 * static_cast<double>(present)) : 0;
    return speed;
  }

  /// The margin at this speed; 0 if it does not pay.
  float chosen(std::size_t moves, double candidates, const CostModel& costs) {
    if (!(speed_ > 0)) return 0;
    margin_ = std::min(kFrames * speed_, max_margin_ * mean_edge_);
    if (!costs.candidatesPay(moves, candidates, margin_ / speed_)) return 0;
    return static_cast<float>(margin_);
  }

  double max_margin_ = 0;
  std::vector<Aabb> sample_;
  double mean_edge_ = 0;
  double speed_ = 0;            ///< in a frame
  double margin_ = 0;           ///< of the present candidates
  std::uint32_t frames_ = 0;    ///< that they have served
  std::uint32_t wait_ = 0;      ///< frames until they are tried again
  std::uint32_t failures_ = 0;  ///< since they served long
};

}  // namespace broadmark::tide
