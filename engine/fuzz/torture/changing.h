// Changes of a world besides its boxes: presence of bodies, collision filters, and their changes.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/collision_filter.h"
#include "torture/inputs.h"

namespace broadmark::inputs {

/// Whether a body is present in a frame.
using Presence = std::function<bool(std::uint32_t body, std::uint32_t frame)>;

namespace presences {

inline bool always(std::uint32_t, std::uint32_t) { return true; }
inline bool never(std::uint32_t, std::uint32_t) { return false; }
/// Some bodies appear and others disappear in every frame; ids are reused at once.
inline bool random(std::uint32_t body, std::uint32_t frame) {
  return Random(body, frame).integer(0, 2) > 0;
}
/// One body in fifty is absent in each frame.
inline bool seldom(std::uint32_t body, std::uint32_t frame) { return (body + frame) % 50 != 0; }
/// All bodies vanish at once, and reappear.
inline bool allOrNone(std::uint32_t, std::uint32_t frame) { return frame % 3 != 2; }
/// A growing number of bodies.
inline bool growing(std::uint32_t body, std::uint32_t frame) { return body < 7 * frame; }
/// A decreasing number of bodies.
inline bool shrinking(std::uint32_t body, std::uint32_t frame) { return body % (frame + 1) == 0; }

}  // namespace presences

struct NamedPresence {
  std::string_view name;
  bool (*present)(std::uint32_t body, std::uint32_t frame);
};
inline constexpr std::array kPresences = {
    NamedPresence{"always", presences::always},
    NamedPresence{"never", presences::never},
    NamedPresence{"random", presences::random},
    NamedPresence{"seldom", presences::seldom},
    NamedPresence{"all or none", presences::allOrNone},
    NamedPresence{"growing", presences::growing},
    NamedPresence{"shrinking", presences::shrinking},
};

/// Generates a body's filter groups.
using Grouping = std::function<BodyGroups(Random& random, std::uint32_t body)>;

/// The default seed is n.
inline CollisionFilter filterOf(std::size_t n, const LayerMatrix& matrix, const Grouping& grouping,
                                std::optional<std::uint64_t> seed = {}) {
  Random random(seed.value_or(n), 0);
  std::vector<BodyGroups> bodies;
  for (std::uint32_t body = 0; body < n; ++body) bodies.push_back(grouping(random, body));
  return {bodies, matrix};
}

struct NamedFilter {
  std::string name;
  CollisionFilter filter;
};

/// Filters of n bodies, each kind separately and all combined.
inline std::vector<NamedFilter> filters(std::size_t n, std::optional<std::uint64_t> seed = {}) {
  const auto make = [=](const LayerMatrix& matrix, const Grouping& grouping) {
    return filterOf(n, matrix, grouping, seed);
  };
  const auto number = [](Random& random, int max) {
    return static_cast<std::uint32_t>(random.integer(0, max));
  };
  const auto layer = [=](Random& random, int max) {
    return static_cast<std::uint8_t>(number(random, max));
  };
  LayerMatrix mixed;
  Random random(1, 1);
  for (std::size_t a = 0; a < LayerMatrix::kLayers; ++a) {
    for (std::size_t b = 0; b <= a; ++b) mixed.set(a, b, random.integer(0, 1) == 0);
  }
  // Layer 0: fixtures, layer 1: bodies that collide with all, layer 2: triggers, only with layer 1.
  const LayerMatrix triggers = LayerMatrix().set(0, 1).set(1, 1).set(2, 1);
  const LayerMatrix one_layer = LayerMatrix().set(0, 0);
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
       make(triggers, [=](Random& r, std::uint32_t) { return BodyGroups{.layer = layer(r, 2)}; })},
      {"a level and a few bodies", make(level,
                                        [=](Random& r, std::uint32_t) {
                                          const bool is_level = r.integer(0, 9) > 0;
                                          return BodyGroups{.layer = std::uint8_t{!is_level}};
                                        })},
      {"32 layers",
       make(mixed, [=](Random& r, std::uint32_t) { return BodyGroups{.layer = layer(r, 31)}; })},
      {"full matrix",
       make(LayerMatrix::all(),
            [=](Random& r, std::uint32_t) { return BodyGroups{.layer = layer(r, 31)}; })},
      {"no pair wanted", make(LayerMatrix(), [](Random&, std::uint32_t) { return BodyGroups{}; })},
      {"worlds", make(one_layer,
                      [=](Random& r, std::uint32_t) { return BodyGroups{.world = number(r, 9)}; })},
      {"a world each",
       make(one_layer, [](Random&, std::uint32_t body) { return BodyGroups{.world = body}; })},
      {"tags", make(one_layer,
                    [=](Random& r, std::uint32_t) {
                      return BodyGroups{.tags = {number(r, 30), number(r, 30), number(r, 30)}};
                    })},
      {"all at once", make(mixed, any)},
  };
}

/// Whether a body gets another layer and other tags in a frame.
using FilterChange = std::function<bool(std::uint32_t body, std::uint32_t frame)>;

namespace filter_changes {

/// One body in thirty in each frame.
inline bool few(std::uint32_t body, std::uint32_t frame) { return (body + 7 * frame) % 30 == 0; }
/// Half of the bodies in each frame.
inline bool half(std::uint32_t body, std::uint32_t frame) {
  return Random(body, frame + 1000).onceIn(2);
}
/// All bodies at once, now and then.
inline bool allOrNone(std::uint32_t, std::uint32_t frame) { return frame % 3 == 1; }

}  // namespace filter_changes

struct NamedFilterChange {
  std::string_view name;
  bool (*changes)(std::uint32_t body, std::uint32_t frame);
};
inline constexpr std::array kFilterChanges = {
    NamedFilterChange{"few", filter_changes::few},
    NamedFilterChange{"half", filter_changes::half},
    NamedFilterChange{"all or none", filter_changes::allOrNone},
};

/// The filters of frames 0 to `last`, n bodies in each. Each change gives a body the layer and tags
/// that a random body had at first, or a random layer and tag.
inline std::vector<CollisionFilter> changingFilters(const CollisionFilter& first, std::size_t n,
                                                    std::uint32_t last, const FilterChange& changes,
                                                    std::uint64_t seed) {
  std::vector filters = {first};
  for (std::uint32_t frame = 1; frame <= last; ++frame) {
    Random random(seed, frame);
    std::vector<std::uint32_t> changed;
    std::vector<BodyGroups> groups;
    for (std::uint32_t body = 0; body < n; ++body) {
      if (!changes(body, frame)) continue;
      changed.push_back(body);
      const int other = random.integer(0, static_cast<int>(n) - 1);
      groups.push_back(first.groupsOf(static_cast<std::uint32_t>(other)));
      if (random.onceIn(2)) continue;
      groups.back().layer = static_cast<std::uint8_t>(random.integer(0, 3));
      groups.back().tags = BodyGroups::kNoTags;
      groups.back().tags[1] = static_cast<std::uint32_t>(random.integer(0, 9));
    }
    filters.push_back(changed.empty() ? filters.back() : filters.back().with(changed, groups, n));
  }
  return filters;
}

}  // namespace broadmark::inputs
