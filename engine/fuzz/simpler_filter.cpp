// Simplifies the groups of each body, and the matrix. Layers are few: tries to merge each layer
// with each other layer, in O(layers²) trials. The rest is delta debugging.

#include "simpler_filter.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "delta_debugging.h"

namespace broadmark {
namespace {

/// A filter in modifiable form.
struct MutableFilter {
  std::vector<BodyGroups> bodies;
  LayerMatrix matrix;

  [[nodiscard]] CollisionFilter build() const { return {bodies, matrix}; }
};

using LayerPair = std::pair<std::size_t, std::size_t>;

class FilterShrinker {
 public:
  FilterShrinker(const CollisionFilter& filter, std::size_t bodies,
                 const std::function<bool(const CollisionFilter&)>& still_fails)
      : still_fails_(still_fails), best_{{}, filter.matrix()} {
    for (std::uint32_t body = 0; body < bodies; ++body) {
      best_.bodies.push_back(filter.groupsOf(body));
    }
  }

  bool shrink() {
    MutableFilter none{std::vector<BodyGroups>(best_.bodies.size()), LayerMatrix().set(0, 0)};
    if (fails(none)) return true;
    bool simpler = removeAllLayers() || mergeLayers();
    simpler = removeExceptions() || simpler;
    simpler = clearUnusedLayers() || simpler;
    simpler = removeWorlds() || simpler;
    return removeTags() || simpler;
  }

 private:
  bool fails(const MutableFilter& filter) {
    if (!still_fails_(filter.build())) return false;
    best_ = filter;
    return true;
  }

  [[nodiscard]] std::vector<std::size_t> layers() const {
    std::set<std::size_t> used;
    for (const BodyGroups& body : best_.bodies) used.insert(body.layer);
    return {used.begin(), used.end()};
  }

  bool removeAllLayers() {
    MutableFilter simpler = best_;
    for (BodyGroups& body : simpler.bodies) body.layer = 0;
    simpler.matrix = LayerMatrix().set(0, 0);
    const bool had_any = simpler.bodies != best_.bodies || !best_.matrix.collide(0, 0);
    return had_any && fails(simpler);
  }

  bool mergeLayers() {
    bool any = false;
    for (const std::size_t layer : layers()) {
      for (const std::size_t other : layers()) {
        if (other == layer) continue;
        MutableFilter simpler = best_;
        for (BodyGroups& body : simpler.bodies) {
          if (body.layer == layer) body.layer = static_cast<std::uint8_t>(other);
        }
        if (!fails(simpler)) continue;
        any = true;
        break;
      }
    }
    return any;
  }

  bool removeExceptions() {
    std::vector<LayerPair> exceptions;
    const std::vector<std::size_t> used = layers();
    for (const std::size_t a : used) {
      for (const std::size_t b : used) {
        if (a <= b && !best_.matrix.collide(a, b)) exceptions.emplace_back(a, b);
      }
    }
    const MutableFilter before = best_;
    return minimize(exceptions, 0, [&](const std::vector<LayerPair>& fewer) {
      MutableFilter simpler = before;
      for (const auto& [a, b] : exceptions) simpler.matrix.set(a, b);
      for (const auto& [a, b] : fewer) simpler.matrix.set(a, b, false);
      return fails(simpler);
    });
  }

  bool clearUnusedLayers() {
    MutableFilter simpler{best_.bodies, LayerMatrix()};
    const std::vector<std::size_t> used = layers();
    for (const std::size_t a : used) {
      for (const std::size_t b : used) simpler.matrix.set(a, b, best_.matrix.collide(a, b));
    }
    return simpler.matrix != best_.matrix && fails(simpler);
  }

  bool removeWorlds() {
    std::set<std::uint32_t> used;
    for (const BodyGroups& body : best_.bodies) used.insert(body.world);
    if (used == std::set<std::uint32_t>{0}) return false;
    const MutableFilter before = best_;
    return minimize(std::vector(used.begin(), used.end()), 0,
                    [&](const std::vector<std::uint32_t>& fewer) {
                      MutableFilter simpler = before;
                      for (BodyGroups& body : simpler.bodies) {
                        if (std::ranges::binary_search(fewer, body.world)) continue;
                        body.world = fewer.empty() ? 0 : fewer.front();
                      }
                      return fails(simpler);
                    });
  }

  bool removeTags() {
    std::set<std::uint32_t> used;
    for (const BodyGroups& body : best_.bodies) used.insert(body.tags.begin(), body.tags.end());
    used.erase(BodyGroups::kNoTag);
    const MutableFilter before = best_;
    return minimize(std::vector(used.begin(), used.end()), 0,
                    [&](const std::vector<std::uint32_t>& fewer) {
                      MutableFilter simpler = before;
                      for (BodyGroups& body : simpler.bodies) {
                        for (std::uint32_t& tag : body.tags) {
                          if (!std::ranges::binary_search(fewer, tag)) tag = BodyGroups::kNoTag;
                        }
                      }
                      return fails(simpler);
                    });
  }

  const std::function<bool(const CollisionFilter&)>& still_fails_;
  MutableFilter best_;  ///< the simplest failing filter
};

}  // namespace

bool simplifyFilter(CollisionFilter filter, std::size_t bodies,
                    const std::function<bool(const CollisionFilter&)>& still_fails) {
  if (filter.wantsAll()) return false;
  return FilterShrinker(filter, bodies, still_fails).shrink();
}

}  // namespace broadmark
