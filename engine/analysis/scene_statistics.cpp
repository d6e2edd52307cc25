// Statistics of scenes: O(n log n + candidate pairs) for each frame.

#include "broadmark/analysis/scene_statistics.h"

#include <algorithm>
#include <array>
#include <map>

#include "broadmark/execution.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/json_fields.h"
#include "broadmark/statistics/statistics.h"

namespace broadmark {
namespace {

double volume(const Aabb& box) {
  double volume = 1;
  for (int axis = 0; axis < 3; ++axis) volume *= double{box.max[axis]} - double{box.min[axis]};
  return volume;
}

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }

/// The mean of one figure over frames.
template <class Figure>
double meanOf(std::span<const FrameStatistics> frames, Figure figure) {
  double sum = 0;
  for (const FrameStatistics& frame : frames) sum += frame.*figure;
  return sum / static_cast<double>(frames.size());
}

Changes meanOf(std::span<const Changes> frames) {
  Changes sum;
  for (const Changes& frame : frames) {
    sum.appeared += frame.appeared;
    sum.vanished += frame.vanished;
    sum.changed += frame.changed;
  }
  const auto count = static_cast<double>(frames.size());
  return {sum.appeared / count, sum.vanished / count, sum.changed / count};
}

/// Bodies and pairs by layer, summed over frames.
class FilterTally {
 public:
  explicit FilterTally(const SceneInfo& scene) : scene_(scene) { addLayers(scene.filter); }

  void add(const Frame& frame, std::span<const Pair> pairs) {
    ++frames_;
    const CollisionFilter& filter = frame.filterIn(scene_);
    if (!frame.filter_changed.empty()) addLayers(filter);
    changed_ += static_cast<double>(frame.filter_changed.size());
    for (std::uint32_t body = 0; body < frame.boxes.size(); ++body) {
      bodies_[filter.layerOf(body)] += isEmpty(frame.boxes[body]) ? 0 : 1;
    }
    for (const Pair pair : pairs) {
      const auto [a, b] = std::minmax({filter.layerOf(pair.a), filter.layerOf(pair.b)});
      pairs_[a][b] += 1;
    }
  }

  [[nodiscard]] FilterStatistics statistics() const {
    FilterStatistics statistics;
    if (scene_.filter_changes) statistics.changed = changed_ / frames_;
    std::map<std::uint32_t, std::uint32_t> worlds;
    for (std::uint32_t body = 0; body < scene_.objects; ++body) {
      const BodyGroups groups = scene_.filter.groupsOf(body);
      statistics.largest_world = std::max(statistics.largest_world, ++worlds[groups.world]);
      statistics.tagged += groups.tags == BodyGroups::kNoTags ? 0 : 1;
    }
    statistics.worlds = static_cast<std::uint32_t>(worlds.size());
    const LayerMatrix matrix = scene_.filter.matrix();
    for (std::size_t a = 0; a < is_used_.size(); ++a) {
      if (!is_used_[a]) continue;
      statistics.layers.push_back({a, bodies_[a] / frames_});
      for (std::size_t b = a; b < is_used_.size(); ++b) {
        if (!is_used_[b] || !matrix.collide(a, b)) continue;
        statistics.layer_pairs.push_back({a, b, pairs_[a][b] / frames_});
      }
    }
    return statistics;
  }

 private:
  template <class T>
  using ByLayer = std::array<T, LayerMatrix::kLayers>;

  void addLayers(const CollisionFilter& filter) {
    for (std::uint32_t body = 0; body < scene_.objects; ++body) {
      is_used_[filter.layerOf(body)] = true;
    }
  }

  const SceneInfo& scene_;
  ByLayer<bool> is_used_{};  ///< in some frame
  double frames_ = 0;
  double changed_ = 0;
  ByLayer<double> bodies_{};
  ByLayer<ByLayer<double>> pairs_{};
};

Json toJson(const RangeStatistics& range, const SceneInfo& scene) {
  Json json = {{"first_frame", range.first},
               {"last_frame", range.last},
               {"density", range.density},
               {"pairs_per_body", range.pairs_per_body},
               {"moving_share", orNull(range.moving_share)},
               {"max_outside", range.max_outside},
               {"min_extent", range.min_extent},
               {"median_extent", range.median_extent},
               {"max_extent", range.max_extent},
               {"size_ratio", orNull(range.sizeRatio())}};
  if (scene.all_present) return json;
  json["bodies"] = {
      {"min", range.min_bodies}, {"mean", range.mean_bodies}, {"max", range.max_bodies}};
  const auto change = [&](double Changes::* which) {
    return range.changes ? Json((*range.changes).*which) : Json(nullptr);
  };
  json["appeared"] = change(&Changes::appeared);
  json["vanished"] = change(&Changes::vanished);
  json["changed"] = change(&Changes::changed);
  return json;
}

Json toJson(const FilterStatistics& filter) {
  Json layers = Json::array();
  for (const auto& [layer, bodies] : filter.layers) {
    layers.push_back({{"layer", layer}, {"bodies", bodies}});
  }
  Json pairs = Json::array();
  for (const auto& [a, b, count] : filter.layer_pairs) {
    pairs.push_back({{"layers", {a, b}}, {"pairs", count}});
  }
  Json json = {{"layers", std::move(layers)},
               {"layer_pairs", std::move(pairs)},
               {"worlds", filter.worlds},
               {"largest_world", filter.largest_world},
               {"tagged", filter.tagged}};
  if (filter.changed) json["changed"] = *filter.changed;
  return json;
}

}  // namespace

Changes changesBetween(std::span<const Aabb> before, std::span<const Aabb> boxes) {
  Changes changes;
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    if (boxes[body] == before[body]) continue;
    changes.changed += 1;
    if (isEmpty(before[body])) changes.appeared += 1;
    if (isEmpty(boxes[body])) changes.vanished += 1;
  }
  return changes;
}

FrameStatistics frameStatistics(const SceneInfo& scene, const Frame& frame,
                                std::span<const Aabb> before, std::size_t pairs) {
  FrameStatistics statistics{.frame = frame.index};
  std::vector<double> extents;
  double filled = 0;
  for (const Aabb& box : frame.boxes) {
    if (isEmpty(box)) continue;
    extents.push_back(longestEdge(box));
    filled += volume(box);
    if (!holdsCentre(scene.world, box)) ++statistics.outside;
  }
  statistics.bodies = static_cast<std::uint32_t>(extents.size());
  if (!before.empty()) {
    const Changes changes = changesBetween(before, frame.boxes);
    statistics.changes = changes;
    const double stayed = statistics.bodies - changes.appeared;
    const double moved = changes.changed - changes.appeared - changes.vanished;
    if (stayed > 0) statistics.moving_share = moved / stayed;
  }
  if (extents.empty()) return statistics;
  statistics.density = ratio(filled, volume(scene.world));
  const auto [min, max] = std::ranges::minmax(extents);
  statistics.min_extent = min;
  statistics.median_extent = quantile(extents, 0.5);
  statistics.max_extent = max;
  statistics.pairs_per_body = static_cast<double>(pairs) / statistics.bodies;
  return statistics;
}

std::optional<double> RangeStatistics::sizeRatio() const {
  if (min_extent == 0) return std::nullopt;
  return max_extent / min_extent;
}

RangeStatistics rangeStatistics(std::span<const FrameStatistics> frames) {
  RangeStatistics range{.first = frames.front().frame,
                        .last = frames.back().frame,
                        .min_bodies = frames.front().bodies,
                        .mean_bodies = meanOf(frames, &FrameStatistics::bodies),
                        .density = meanOf(frames, &FrameStatistics::density),
                        .pairs_per_body = meanOf(frames, &FrameStatistics::pairs_per_body)};
  std::vector<Changes> changes;
  std::vector<double> moving;
  std::vector<double> medians;
  for (const FrameStatistics& frame : frames) {
    if (frame.changes) changes.push_back(*frame.changes);
    if (frame.moving_share) moving.push_back(*frame.moving_share);
    range.max_outside = std::max(range.max_outside, frame.outside);
    range.min_bodies = std::min(range.min_bodies, frame.bodies);
    range.max_bodies = std::max(range.max_bodies, frame.bodies);
    if (frame.bodies == 0) continue;  // no extents to aggregate
    range.min_extent =
        medians.empty() ? frame.min_extent : std::min(range.min_extent, frame.min_extent);
    range.max_extent = std::max(range.max_extent, frame.max_extent);
    medians.push_back(frame.median_extent);
  }
  if (!changes.empty()) range.changes = meanOf(changes);
  if (!moving.empty()) range.moving_share = mean(moving);
  range.median_extent = quantile(medians, 0.5);
  return range;
}

std::optional<SceneDescription> describe(FrameSource& source, int parts,
                                         const FrameProgress& progress) {
  const SceneInfo& scene = source.scene();
  std::vector<FrameStatistics> frames;
  std::vector<Aabb> before;
  const bool is_filtered = !scene.filter.wantsAll() || scene.filter_changes;
  FilterTally tally(scene);
  const auto describe_frame = [&](const Frame& frame) {
    const std::vector<Pair> pairs = sweptPairs(frame.boxes, frame.filterIn(scene), scene.periodic);
    frames.push_back(frameStatistics(scene, frame, before, pairs.size()));
    if (is_filtered && (frame.index > 0 || scene.frames == 0)) {
      tally.add(frame, pairs);
    }
    before.assign(frame.boxes.begin(), frame.boxes.end());
  };
  if (!recordAll(source, describe_frame, progress)) return std::nullopt;
  const std::span all(frames);
  SceneDescription description{
      .initial = rangeStatistics(all.first(1)), .parts = {}, .overall = {}};
  if (is_filtered) description.filter = tally.statistics();
  const auto updated = all.subspan(1);
  if (updated.empty()) return description;
  const int count = static_cast<int>(std::min<std::size_t>(updated.size(), parts));
  for (int part = 0; part < count; ++part) {
    const auto [begin, end] = share(updated.size(), count, part);
    description.parts.push_back(rangeStatistics(updated.subspan(begin, end - begin)));
  }
  description.overall = rangeStatistics(updated);
  return description;
}

std::string formatDescriptions(std::span<const DescribedRecording> recordings) {
  Json list = Json::array();
  for (const DescribedRecording& recording : recordings) {
    const SceneInfo& scene = recording.scene;
    const auto& [initial, parts, overall, filter] = recording.description;
    Json ranges = Json::array();
    for (const RangeStatistics& part : parts) ranges.push_back(toJson(part, scene));
    list.push_back({{"source", recording.path},
                    {"hash", recording.hash},
                    {"name", scene.name},
                    {"object_type", scene.object_type},
                    {"objects", scene.objects},
                    {"frames", scene.frames},
                    {"initial", toJson(initial, scene)},
                    {"parts", std::move(ranges)},
                    {"overall", overall ? toJson(*overall, scene) : Json(nullptr)}});
    if (filter) list.back()["filter"] = toJson(*filter);
  }
  const Json json = {{"schema", "broadmark-descriptions/1"}, {"recordings", std::move(list)}};
  // A path need not be UTF-8.
  return formatJson(json);
}

}  // namespace broadmark
