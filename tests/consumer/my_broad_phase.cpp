// Runs, checks and times a custom broad phase beside Broadmark's, on custom frames and on a scene
// that Broadmark simulates.

#include <broadmark/algorithms.h>
#include <broadmark/harness/runner.h>
#include <broadmark/scenes/simulation.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "all_pairs.h"

namespace {

/// Unit boxes at random positions: an example of a custom frame source.
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

/// Runs every algorithm on these frames. Returns whether all were correct and found pairs.
bool allRight(const std::vector<broadmark::Algorithm>& algorithms, broadmark::FrameSource& frames) {
  bool right = true;
  for (const auto& algorithm : algorithms) {
    const auto result = broadmark::runCase({.algorithm = algorithm}, frames);
    std::printf("%-10s %-15s %-10s %.2e s/frame, %.0f pairs\n", frames.scene().name.c_str(),
                result.algorithm.c_str(), broadmark::statusName(result.status).data(),
                result.summary().seconds_per_frame, result.pairs_mean);
    right &= result.status == broadmark::Status::ok;
    if (algorithm.traits.finds_pairs) right &= result.pairs_mean > 0;
  }
  return right;
}

}  // namespace

int main() {
  std::vector<broadmark::Algorithm> algorithms = broadmark::builtinAlgorithms();
  algorithms.push_back(
      {.id = "mine", .family = "Mine", .create = [] { return std::make_unique<AllPairs>(); }});
  JumpingBoxes boxes;
  const auto scene = broadmark::makeSimulation("freefall");
  broadmark::setParameters(*scene, {{"objects", "200"}, {"frames", "10"}});
  broadmark::FrameList simulated(*scene);
  const bool boxes_right = allRight(algorithms, boxes);
  return allRight(algorithms, simulated) && boxes_right ? 0 : 1;
}
