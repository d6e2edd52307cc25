// A broad phase of one's own, run, checked and timed beside Broadmark's.

#include <broadmark/algorithms.h>
#include <broadmark/runner.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "all_pairs.h"

namespace {

/// Unit boxes that jump about: frames can come from anywhere.
class JumpingBoxes : public broadmark::FrameSource {
 public:
  JumpingBoxes()
      : scene_{.name = "Jumping", .object_type = "Cubes", .objects = 500, .frames = 10} {}
  const broadmark::SceneInfo& scene() const override { return scene_; }
  broadmark::Frame rewind() override { return frame(0); }
  std::optional<broadmark::Frame> next() override {
    if (index_ == scene_.frames) return std::nullopt;
    return frame(index_ + 1);
  }

 private:
  broadmark::Frame frame(std::uint32_t index) {
    index_ = index;
    std::mt19937 random(index);
    boxes_.resize(scene_.objects);
    for (broadmark::Aabb& box : boxes_) {
      for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = static_cast<float>(random() % 1000) / 100;
        box.max[axis] = box.min[axis] + 1;
      }
    }
    return {index, boxes_};
  }

  broadmark::SceneInfo scene_;
  std::vector<broadmark::Aabb> boxes_;
  std::uint32_t index_ = 0;
};

}  // namespace

int main() {
  std::vector<broadmark::Algorithm> algorithms = broadmark::builtinAlgorithms();
  algorithms.push_back(
      {.id = "mine", .family = "Mine", .create = [] { return std::make_unique<AllPairs>(); }});
  bool all_ok = true;
  for (const auto& algorithm : algorithms) {
    JumpingBoxes boxes;
    const auto result = broadmark::runCase({.algorithm = algorithm}, boxes);
    std::printf("%-15s %-10s %.2e s/frame, %.0f pairs\n", result.algorithm.c_str(),
                broadmark::statusName(result.status).data(), result.summary().seconds_per_frame,
                result.pairs_mean);
    all_ok &= result.status == broadmark::Status::ok;
    if (algorithm.traits.finds_pairs) all_ok &= result.pairs_mean > 0;
  }
  return all_ok ? 0 : 1;
}
