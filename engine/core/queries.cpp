#include "broadmark/queries.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace broadmark {
namespace {

/// The number that splitmix64 derives from another.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9U;
  x = (x ^ x >> 27) * 0x94d049bb133111ebU;
  return x ^ x >> 31;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(mixed(seed)) {}

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(mixed(state_++) >> 11) * 0x1p-53; }
  std::size_t index(std::size_t count) {
    return std::min(static_cast<std::size_t>(uniform() * static_cast<double>(count)), count - 1);
  }

 private:
  std::uint64_t state_;
};

struct Bounds {
  Aabb box = kEmptyBox;
  double mean_edge = 0;
  double diagonal = 0;
};

Bounds boundsOf(std::span<const Aabb> boxes, std::span<const std::uint32_t> present) {
  Bounds bounds;
  for (const std::uint32_t body : present) {
    bounds.box = merged(bounds.box, boxes[body]);
    bounds.mean_edge += longestEdge(boxes[body]) / static_cast<double>(present.size());
  }
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    square += std::pow(double{bounds.box.max[axis]} - double{bounds.box.min[axis]}, 2);
  }
  bounds.diagonal = std::sqrt(square);
  return bounds;
}

float finite(double value) {
  constexpr double kMax = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -kMax, kMax));
}

/// A box that moves, relative to a body: hit if the motion meets [min, max] on all axes at once.
struct RelativeBox {
  std::array<double, 3> min;
  std::array<double, 3> max;
  double tolerance = 0;
};

RelativeBox relativeBox(const Query& query, const Aabb& body) {
  constexpr double kUnits = 64 * std::numeric_limits<float>::epsilon();
  RelativeBox relative;
  double largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    relative.min[axis] = double{body.min[axis]} - double{query.box.max[axis]};
    relative.max[axis] = double{body.max[axis]} - double{query.box.min[axis]};
    for (const float coordinate : {body.min[axis], body.max[axis], query.box.min[axis],
                                   query.box.max[axis], query.motion[axis]}) {
      largest = std::max(largest, std::fabs(double{coordinate}));
    }
  }
  relative.tolerance = kUnits * largest;
  return relative;
}

/// Whether the motion meets the box, grown by `margin`, within its time from 0 to 1. A negative
/// margin shrinks it, at most to its centre.
bool meets(const Query& query, const RelativeBox& box, double margin) {
  double enter = 0;
  double leave = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double half = (box.max[axis] - box.min[axis]) / 2;
    const double min = box.min[axis] - std::max(margin, -half);
    const double max = box.max[axis] + std::max(margin, -half);
    const double motion = query.motion[axis];
    if (motion == 0) {
      if (min > 0 || max < 0) return false;
      continue;
    }
    enter = std::max(enter, (motion > 0 ? min : max) / motion);
    leave = std::min(leave, (motion > 0 ? max : min) / motion);
  }
  return enter <= leave;
}

double distance(const RelativeBox& box) {
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    square += std::pow(std::max({box.min[axis], -box.max[axis], 0.0}), 2);
  }
  return std::sqrt(square);
}

/// Adds the hits of a query for the nearest bodies.
void findNearest(std::uint32_t index, const Query& query, std::span<const Aabb> boxes,
                 HitBounds& hits) {
  std::vector<std::pair<double, std::uint32_t>> nearest;
  double tolerance = 0;
  for (std::uint32_t body = 0; body < boxes.size(); ++body) {
    if (isEmpty(boxes[body])) continue;
    const RelativeBox relative = relativeBox(query, boxes[body]);
    nearest.emplace_back(distance(relative), body);
    tolerance = std::max(tolerance, relative.tolerance);
  }
  const std::size_t count = std::min(kNearestBodies, nearest.size());
  hits.min_count += count;
  if (count == 0) return;
  std::ranges::nth_element(nearest, nearest.begin() + static_cast<std::ptrdiff_t>(count) - 1);
  const double farthest = nearest[count - 1].first;
  std::ranges::sort(nearest, {}, [](const auto& found) { return found.second; });
  for (const auto& [distance, body] : nearest) {
    if (distance < farthest - tolerance || nearest.size() == count) {
      hits.certain.push_back({index, body});
    }
    if (distance <= farthest + tolerance) hits.possible.push_back({index, body});
  }
}

}  // namespace

bool hits(AnswerKind kind, const Query& query, const Aabb& body) {
  if (isEmpty(body)) return false;
  if (kind == AnswerKind::boxes) return overlaps(query.box, body);
  return meets(query, relativeBox(query, body), 0);
}

double distanceTo(const Query& query, const Aabb& body) {
  return distance(relativeBox(query, body));
}

float largestCoordinate(std::span<const Aabb> boxes) {
  float largest = 0;
  for (const Aabb& box : boxes) {
    if (isEmpty(box)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      largest = std::max({largest, -box.min[axis], box.max[axis]});
    }
  }
  return largest;
}

std::string answerName(Answer answer) {
  if (!isQuery(answer)) return std::string(kAnswerKinds.nameOf(answer.kind));
  return fmt::format("{}:{}", kQueryKinds.nameOf(answer.kind), answer.queries);
}

std::optional<Answer> findAnswer(std::string_view name) {
  if (const auto kind = kAnswerKinds.find(name)) return *kind;
  const std::size_t colon = name.find(':');
  if (colon == name.npos) return std::nullopt;
  const auto kind = kQueryKinds.find(name.substr(0, colon));
  const std::string_view number = name.substr(colon + 1);
  std::uint32_t count = 0;
  const auto [end, error] = std::from_chars(number.begin(), number.end(), count);
  if (!kind || error != std::errc() || end != number.end()) return std::nullopt;
  if (count == 0 || count > kMaxQueries) return std::nullopt;
  return Answer(*kind, count);
}

std::vector<Query> makeQueries(Answer answer, std::span<const Aabb> boxes, std::uint32_t frame) {
  std::vector<std::uint32_t> present;
  for (std::uint32_t body = 0; body < boxes.size(); ++body) {
    if (!isEmpty(boxes[body])) present.push_back(body);
  }
  if (present.empty()) return {};
  const Bounds bounds = boundsOf(boxes, present);
  const AnswerKind kind = answer.kind;
  double edge = 0;
  if (kind == AnswerKind::boxes) edge = 4 * bounds.mean_edge;
  if (kind == AnswerKind::sweeps) edge = bounds.mean_edge;
  double length = 0;
  if (kind == AnswerKind::rays) length = bounds.diagonal / 4;
  if (kind == AnswerKind::sweeps) length = 8 * bounds.mean_edge;

  Random random(std::uint64_t{frame} << 32 | static_cast<std::uint32_t>(kind));
  std::vector<Query> queries(answer.queries);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const Aabb& start = boxes[present[random.index(present.size())]];
    // Uniform directions: Archimedes' theorem.
    const double height = 2 * random.uniform() - 1;
    const double radius = std::sqrt(1 - height * height);
    const double angle = 2 * std::numbers::pi * random.uniform();
    const std::array<double, 3> direction = {radius * std::cos(angle), radius * std::sin(angle),
                                             height};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double anywhere =
          std::lerp(double{bounds.box.min[axis]}, double{bounds.box.max[axis]}, random.uniform());
      const double centre = i % 2 == 0 ? centreOf(start, axis) : anywhere;
      queries[i].box.min[axis] = finite(centre - edge / 2);
      queries[i].box.max[axis] = finite(centre + edge / 2);
      queries[i].motion[axis] = finite(length * direction[axis]);
    }
  }
  return queries;
}

HitBounds findHits(const QueryBatch& batch, std::span<const Aabb> boxes) {
  HitBounds hits;
  for (std::uint32_t i = 0; i < batch.queries.size(); ++i) {
    const Query& query = batch.queries[i];
    if (batch.kind == AnswerKind::nearest) {
      findNearest(i, query, boxes, hits);
      continue;
    }
    for (std::uint32_t body = 0; body < boxes.size(); ++body) {
      if (isEmpty(boxes[body])) continue;
      if (batch.kind == AnswerKind::boxes) {
        if (!overlaps(query.box, boxes[body])) continue;
        hits.certain.push_back({i, body});
        hits.possible.push_back({i, body});
        continue;
      }
      const RelativeBox relative = relativeBox(query, boxes[body]);
      if (meets(query, relative, -relative.tolerance)) hits.certain.push_back({i, body});
      if (meets(query, relative, relative.tolerance)) hits.possible.push_back({i, body});
    }
  }
  if (batch.kind != AnswerKind::nearest) hits.min_count = hits.certain.size();
  return hits;
}

}  // namespace broadmark
