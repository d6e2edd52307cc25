// Statistics of scenes: O(n log n + candidate pairs) for each frame.

#include "broadmark/scene_statistics.h"

#include <algorithm>
#include <array>
#include <ranges>

#include "broadmark/execution.h"
#include "broadmark/json_fields.h"
#include "broadmark/oracle.h"
#include "broadmark/statistics.h"

namespace broadmark {
namespace {

std::array<double, 3> edges(const Aabb& box) {
  std::array<double, 3> lengths{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lengths[axis] = double{box.max[axis]} - double{box.min[axis]};
  }
  return lengths;
}

double volume(const Aabb& box) {
  const auto [x, y, z] = edges(box);
  return x * y * z;
}

bool holdsCentre(const Aabb& world, const Aabb& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const double centre = (double{box.min[axis]} + double{box.max[axis]}) / 2;
    if (centre < world.min[axis] || centre > world.max[axis]) return false;
  }
  return true;
}

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }

/// The mean of one figure over frames.
template <class Figure>
double meanOf(std::span<const FrameStatistics> frames, Figure figure) {
  double sum = 0;
  for (const FrameStatistics& frame : frames) sum += frame.*figure;
  return sum / static_cast<double>(frames.size());
}

Json toJson(const RangeStatistics& range) {
  return {{"first_frame", range.first},
          {"last_frame", range.last},
          {"density", range.density},
          {"pairs_per_body", range.pairs_per_body},
          {"moving_share", orNull(range.moving_share)},
          {"max_outside", range.max_outside},
          {"min_extent", range.min_extent},
          {"median_extent", range.median_extent},
          {"max_extent", range.max_extent},
          {"size_ratio", orNull(range.sizeRatio())}};
}

}  // namespace

FrameStatistics frameStatistics(const SceneInfo& scene, const Frame& frame,
                                std::span<const Aabb> before) {
  FrameStatistics figures{.frame = frame.index};
  const std::span<const Aabb> boxes = frame.boxes;
  if (boxes.empty()) return figures;
  const auto bodies = static_cast<double>(boxes.size());

  std::vector<double> extents(boxes.size());
  double filled = 0;
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    extents[body] = std::ranges::max(edges(boxes[body]));
    filled += volume(boxes[body]);
    if (!holdsCentre(scene.world, boxes[body])) ++figures.outside;
  }
  figures.density = ratio(filled, volume(scene.world));
  const auto [min, max] = std::ranges::minmax(extents);
  figures.min_extent = min;
  figures.median_extent = quantile(extents, 0.5);
  figures.max_extent = max;

  figures.pairs_per_body = static_cast<double>(sweptPairs(boxes, scene.filter).size()) / bodies;
  if (before.empty()) return figures;
  const auto still =
      std::ranges::count(std::views::iota(std::size_t{0}, boxes.size()), true,
                         [&](std::size_t body) { return boxes[body] == before[body]; });
  figures.moving_share = 1 - static_cast<double>(still) / bodies;
  return figures;
}

std::optional<double> RangeStatistics::sizeRatio() const {
  if (min_extent == 0) return std::nullopt;
  return max_extent / min_extent;
}

RangeStatistics rangeStatistics(std::span<const FrameStatistics> frames) {
  RangeStatistics range{.first = frames.front().frame,
                        .last = frames.back().frame,
                        .density = meanOf(frames, &FrameStatistics::density),
                        .pairs_per_body = meanOf(frames, &FrameStatistics::pairs_per_body),
                        .min_extent = frames.front().min_extent};
  std::vector<double> moving;
  std::vector<double> medians;
  for (const FrameStatistics& frame : frames) {
    if (frame.moving_share) moving.push_back(*frame.moving_share);
    medians.push_back(frame.median_extent);
    range.max_outside = std::max(range.max_outside, frame.outside);
    range.min_extent = std::min(range.min_extent, frame.min_extent);
    range.max_extent = std::max(range.max_extent, frame.max_extent);
  }
  if (!moving.empty()) range.moving_share = mean(moving);
  range.median_extent = quantile(medians, 0.5);
  return range;
}

std::optional<SceneDescription> describe(FrameSource& source, int parts,
                                         const FrameProgress& progress) {
  std::vector<FrameStatistics> frames;
  std::vector<Aabb> before;
  for (std::optional<Frame> frame = source.rewind(); frame; frame = source.next()) {
    frames.push_back(frameStatistics(source.scene(), *frame, before));
    before.assign(frame->boxes.begin(), frame->boxes.end());
    if (progress && !progress(frame->index)) return std::nullopt;
  }
  const std::span all(frames);
  SceneDescription description{
      .initial = rangeStatistics(all.first(1)), .parts = {}, .overall = {}};
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
    const auto& [initial, parts, overall] = recording.description;
    Json ranges = Json::array();
    for (const RangeStatistics& part : parts) ranges.push_back(toJson(part));
    list.push_back({{"source", recording.path},
                    {"hash", recording.hash},
                    {"name", recording.scene.name},
                    {"object_type", recording.scene.object_type},
                    {"objects", recording.scene.objects},
                    {"frames", recording.scene.frames},
                    {"initial", toJson(initial)},
                    {"parts", std::move(ranges)},
                    {"overall", overall ? toJson(*overall) : Json(nullptr)}});
  }
  const Json json = {{"schema", "broadmark-descriptions/1"}, {"recordings", std::move(list)}};
  // A path need not be UTF-8.
  return formatJson(json);
}

}  // namespace broadmark
