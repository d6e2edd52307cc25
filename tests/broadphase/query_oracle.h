// Brute-force answers to queries, by the definitions of query_math.h.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "broadphase/worlds.h"
#include "queries/query_math.h"

namespace broadmark::tests {

using Bodies = std::vector<std::uint32_t>;

/// What queries are about: boxes, enlarged if there is a margin, and layers of all bodies.
struct QueryOracle {
  BoxList boxes;
  std::vector<std::uint8_t> layers = {};  ///< default beyond the end

  [[nodiscard]] bool isCandidate(std::uint32_t body, std::uint32_t wanted) const {
    const unsigned layer = body < layers.size() ? layers[body] : 0;
    return !isEmpty(boxes[body]) && (wanted >> layer & 1) != 0;
  }

  [[nodiscard]] Bodies answer(const bp::BoxQuery& query) const {
    const auto& [min, max] = query.box;
    const Aabb box = {{min[0], min[1], min[2], 0}, {max[0], max[1], max[2], 0}};
    Bodies bodies;
    for (std::uint32_t body = 0; body < boxes.size(); ++body) {
      if (isCandidate(body, query.layers) && overlaps(box, boxes[body])) bodies.push_back(body);
    }
    return bodies;
  }

  [[nodiscard]] std::vector<bp::CastHit> answer(const bp::Cast& cast, bp::Hits wanted) const {
    std::vector<bp::CastHit> hits;
    for (std::uint32_t body = 0; body < boxes.size(); ++body) {
      if (!isCandidate(body, cast.layers)) continue;
      double enters = 0;
      double leaves = bp::kNoLimit;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bp::CastAxis moving(cast.box.min[axis], cast.box.max[axis], cast.direction[axis]);
        const float low = boxes[body].min[axis];
        const float high = boxes[body].max[axis];
        enters = std::max(enters, moving.timeOfNear(moving.backwards ? high : low));
        leaves = std::min(leaves, moving.timeOfFar(moving.backwards ? low : high));
      }
      const double limit = bp::castLimit(cast.max_fraction);
      if (enters > std::min(leaves * (1 + bp::kCastTolerance), limit)) continue;
      hits.push_back({std::min<double>(enters, cast.max_fraction), body});
    }
    std::ranges::sort(hits);
    if (wanted == bp::Hits::closest && hits.size() > 1) hits.resize(1);
    return hits;
  }

  [[nodiscard]] std::vector<bp::Neighbour> answer(const bp::NearestQuery& query) const {
    std::vector<bp::Neighbour> all;
    for (std::uint32_t body = 0; body < boxes.size(); ++body) {
      if (!isCandidate(body, query.layers)) continue;
      double squares = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double distance =
            bp::axisDistance(query.point[axis], boxes[body].min[axis], boxes[body].max[axis]);
        squares += distance * distance;
      }
      if (squares <= bp::squaredLimit(query.max_distance)) all.push_back({squares, body});
    }
    std::ranges::sort(all, {}, [](const bp::Neighbour& neighbour) {
      return std::pair(neighbour.distance, neighbour.body);
    });
    if (all.size() > query.count) all.resize(query.count);
    for (bp::Neighbour& neighbour : all) neighbour.distance = std::sqrt(neighbour.distance);
    return all;
  }
};

/// Batches of all kinds of queries, with the memory for their answers.
struct QueryBatches {
  std::vector<bp::BoxQuery> boxes;
  std::vector<bp::Cast> casts;
  std::vector<bp::NearestQuery> points;
  bp::QueryResults<std::uint32_t> bodies = {};
  bp::QueryResults<bp::CastHit> hits[2] = {};
  bp::QueryResults<bp::Neighbour> neighbours = {};

  void run(bp::BroadPhase& object) {
    object.overlapping(boxes, bodies);
    for (const bp::Hits wanted : {bp::Hits::closest, bp::Hits::all}) {
      object.cast(casts, wanted, hits[static_cast<int>(wanted)]);
    }
    object.nearest(points, neighbours);
  }

  [[nodiscard]] bool hasAnswersOf(const QueryBatches& other) const {
    const auto same = [](const auto& a, const auto& b) {
      return a.starts == b.starts && a.items == b.items;
    };
    return same(bodies, other.bodies) && same(hits[0], other.hits[0]) &&
           same(hits[1], other.hits[1]) && same(neighbours, other.neighbours);
  }

  /// Which answer is wrong; "" if none is.
  [[nodiscard]] std::string fault(const QueryOracle& oracle) const {
    const auto differ = [](const auto& found, const auto& right) {
      return !std::ranges::equal(found, right);
    };
    const auto name = [](const char* kind, std::size_t i) { return kind + std::to_string(i); };
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (differ(bodies[i], oracle.answer(boxes[i]))) return name("box ", i);
    }
    for (std::size_t i = 0; i < casts.size(); ++i) {
      for (const bp::Hits wanted : {bp::Hits::closest, bp::Hits::all}) {
        const auto& found = hits[static_cast<int>(wanted)];
        if (differ(found[i], oracle.answer(casts[i], wanted))) return name("cast ", i);
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (differ(neighbours[i], oracle.answer(points[i]))) return name("point ", i);
    }
    return "";
  }
};

}  // namespace broadmark::tests
