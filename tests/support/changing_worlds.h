// Worlds to test algorithms on in which bodies come and go, and not all pairs are wanted.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/collision_filter.h"
#include "broadmark/frame.h"
#include "support/inputs.h"

namespace broadmark::tests {

/// A world of `capacity` bodies over some frames; the same arguments give the same one.
struct ChangingWorld {
  std::string name;
  CollisionFilter filter;
  std::vector<std::vector<Aabb>> frames;
  std::optional<Aabb> bounds = {};  ///< what the scene calls its world; else what holds all boxes
};

/// Which bodies are there in a frame.
using Presence = std::function<bool(std::uint32_t body, std::uint32_t frame)>;

namespace presences {

inline bool always(std::uint32_t, std::uint32_t) { return true; }
inline bool never(std::uint32_t, std::uint32_t) { return false; }
/// Some bodies come and others go in every frame; a number is used again at once.
inline bool random(std::uint32_t body, std::uint32_t frame) {
  return inputs::Random(body, frame).integer(0, 2) > 0;
}
/// One in fifty comes or goes.
inline bool seldom(std::uint32_t body, std::uint32_t frame) { return (body + frame) % 50 != 0; }
/// All vanish at once, and come back.
inline bool allOrNone(std::uint32_t, std::uint32_t frame) { return frame % 3 != 2; }
/// More and more.
inline bool growing(std::uint32_t body, std::uint32_t frame) { return body < 7 * frame; }
/// Fewer and fewer.
inline bool shrinking(std::uint32_t body, std::uint32_t frame) { return body % (frame + 1) == 0; }

}  // namespace presences

/// Makes each body's groups.
using Grouping = std::function<BodyGroups(inputs::Random& random, std::uint32_t body)>;

inline CollisionFilter filterOf(std::size_t n, const LayerMatrix& matrix,
                                const Grouping& grouping) {
  inputs::Random random(n, 0);
  std::vector<BodyGroups> bodies;
  for (std::uint32_t body = 0; body < n; ++body) bodies.push_back(grouping(random, body));
  return {bodies, matrix};
}

struct NamedFilter {
  std::string name;
  CollisionFilter filter;
};

/// Filters of n bodies, each kind alone and all together.
inline std::vector<NamedFilter> filters(std::size_t n) {
  using inputs::Random;
  const auto number = [](Random& random, int most) {
    return static_cast<std::uint32_t>(random.integer(0, most));
  };
  const auto layer = [=](Random& random, int most) {
    return static_cast<std::uint8_t>(number(random, most));
  };
  LayerMatrix some;
  Random random(1, 1);
  for (std::size_t a = 0; a < LayerMatrix::kLayers; ++a) {
    for (std::size_t b = 0; b <= a; ++b) some.set(a, b, random.integer(0, 1) == 0);
  }
  // Layer 0: fixtures, layer 1: bodies that meet all, layer 2: triggers, which meet only these.
  const LayerMatrix usual = LayerMatrix().set(0, 1).set(1, 1).set(2, 1);
  const LayerMatrix one = LayerMatrix().set(0, 0);
  // Layer 0: a level, layer 1: bodies in it.
  const LayerMatrix level = LayerMatrix().set(0, 1).set(1, 1);
  const auto any = [=](Random& r, std::uint32_t) {
    return BodyGroups{.layer = layer(r, 31),
                      .world = number(r, 2),
                      .tags = {number(r, 20), BodyGroups::kNoTag, number(r, 20)}};
  };
  return {
      {"all wanted", {}},
      {"fixtures and triggers",
       filterOf(n, usual,
                [=](Random& r, std::uint32_t) { return BodyGroups{.layer = layer(r, 2)}; })},
      {"a level and a few bodies", filterOf(n, level,
                                            [=](Random& r, std::uint32_t) {
                                              const bool is_level = r.integer(0, 9) > 0;
                                              return BodyGroups{.layer = std::uint8_t{!is_level}};
                                            })},
      {"32 layers",
       filterOf(n, some,
                [=](Random& r, std::uint32_t) { return BodyGroups{.layer = layer(r, 31)}; })},
      {"full matrix",
       filterOf(n, LayerMatrix::all(),
                [=](Random& r, std::uint32_t) { return BodyGroups{.layer = layer(r, 31)}; })},
      {"no pair wanted",
       filterOf(n, LayerMatrix(), [](Random&, std::uint32_t) { return BodyGroups{}; })},
      {"worlds",
       filterOf(n, one,
                [=](Random& r, std::uint32_t) { return BodyGroups{.world = number(r, 9)}; })},
      {"a world each",
       filterOf(n, one, [](Random&, std::uint32_t body) { return BodyGroups{.world = body}; })},
      {"tags", filterOf(n, one,
                        [=](Random& r, std::uint32_t) {
                          return BodyGroups{.tags = {number(r, 30), number(r, 30), number(r, 30)}};
                        })},
      {"all at once", filterOf(n, some, any)},
  };
}

/// The frames of an input, with only those bodies that are there.
inline std::vector<std::vector<Aabb>> framesWith(const inputs::Input& input, std::size_t n,
                                                 std::uint32_t count, const Presence& present) {
  std::vector<std::vector<Aabb>> frames;
  for (std::uint32_t frame = 0; frame < count; ++frame) {
    frames.push_back(input.boxes(n, frame, 1 + n));
    for (std::uint32_t body = 0; body < n; ++body) {
      if (!present(body, frame)) frames.back()[body] = kEmptyBox;
    }
  }
  return frames;
}

/// A scene of given frames.
inline FrameList listed(SceneInfo scene, const std::vector<std::vector<Aabb>>& frames) {
  class Given final : public FrameSource {
   public:
    Given(SceneInfo scene, const std::vector<std::vector<Aabb>>& frames)
        : scene_(std::move(scene)), frames_(frames) {
      scene_.objects = static_cast<std::uint32_t>(frames.front().size());
      scene_.frames = static_cast<std::uint32_t>(frames.size()) - 1;
    }
    [[nodiscard]] const SceneInfo& scene() const override { return scene_; }
    Frame rewind() override { return {index_ = 0, frames_.front()}; }
    std::optional<Frame> next() override {
      if (index_ == scene_.frames) return std::nullopt;
      ++index_;
      return Frame{index_, frames_[index_]};
    }

   private:
    SceneInfo scene_;
    const std::vector<std::vector<Aabb>>& frames_;
    std::uint32_t index_ = 0;
  };
  Given given(std::move(scene), frames);
  return FrameList(given);
}

/// The frames of a scene, with only those bodies that are there.
inline FrameList changing(FrameSource& source, const Presence& present,
                          const CollisionFilter& filter = {}) {
  SceneInfo scene = source.scene();
  scene.all_present = false;
  scene.filter = filter;
  std::vector<std::vector<Aabb>> frames;
  for (std::optional<Frame> frame = source.rewind(); frame; frame = source.next()) {
    frames.emplace_back(frame->boxes.begin(), frame->boxes.end());
    for (std::uint32_t body = 0; body < scene.objects; ++body) {
      if (!present(body, frame->index)) frames.back()[body] = kEmptyBox;
    }
  }
  return listed(std::move(scene), frames);
}

}  // namespace broadmark::tests
