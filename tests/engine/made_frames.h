// Frames written down in a test.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "broadmark/frame.h"

namespace broadmark::tests {

/// Frames in memory, with or without a list of changed bodies.
class MadeFrames final : public IndexedFrames {
 public:
  MadeFrames(std::vector<std::vector<Aabb>> frames, bool lists_changed)
      : frames_(std::move(frames)) {
    scene_.name = "Made";
    scene_.objects = static_cast<std::uint32_t>(frames_.front().size());
    scene_.frames = static_cast<std::uint32_t>(frames_.size() - 1);
    scene_.all_present = false;
    if (lists_changed) changed_.emplace();
  }
  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    // A copy: a frame is valid until the next call only.
    now_ = frames_[index];
    if (!changed_) return now_;
    changed_->clear();
    for (std::uint32_t body = 0; index > 0 && body < now_.size(); ++body) {
      if (now_[body] != frames_[index - 1][body]) changed_->push_back(body);
    }
    return now_;
  }
  [[nodiscard]] std::optional<std::span<const std::uint32_t>> changed() const override {
    return changed_;
  }

  SceneInfo scene_;
  std::vector<std::vector<Aabb>> frames_;
  std::vector<Aabb> now_;
  std::optional<std::vector<std::uint32_t>> changed_;
};

}  // namespace broadmark::tests
