#include "inspector/run/snapshot.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace broadmark {
namespace {

/// Maximum number of frames in a trail.
constexpr std::uint32_t kTrailFrames = 60;

std::vector<Trail> trailsOf(const SnapshotRequest& request) {
  std::vector<Trail> trails;
  const std::uint32_t first = request.frame - std::min(request.frame, kTrailFrames - 1);
  for (const std::uint32_t body : request.trail_bodies) {
    if (body < request.provider.scene().objects) trails.push_back({.body = body, .first = first});
  }
  if (trails.empty()) return trails;
  for (std::uint32_t index = first; index <= request.frame; ++index) {
    const Frame frame = request.provider.at(index);
    for (Trail& trail : trails) trail.boxes.push_back(frame.boxes[trail.body]);
  }
  return trails;
}

std::shared_ptr<const std::vector<Aabb>> copyOf(std::span<const Aabb> boxes) {
  return std::make_shared<const std::vector<Aabb>>(boxes.begin(), boxes.end());
}

CachedAnswer oracleAnswer(const SnapshotRequest& request, const Frame& frame, Oracle& oracle) {
  if (request.cache != nullptr) {
    if (auto cached = request.cache->find(0, frame.index)) return std::move(*cached);
  }
  const SceneInfo& scene = request.provider.scene();
  const std::span<const Pair> pairs =
      oracle.pairs(frame.boxes, frame.filterIn(scene), scene.periodic);
  CachedAnswer answer{.pairs = {pairs.begin(), pairs.end()}, .checked = true};
  if (request.cache != nullptr) request.cache->insert(0, frame.index, answer);
  return answer;
}

/// Moves an answer into a snapshot that already holds the boxes, and counts the overlaps.
void applyAnswer(CachedAnswer answer, bool check, Snapshot& snapshot) {
  const auto overlaps_in = [&](const PairRun& found) {
    return overlapCounts(snapshot.boxes->size(), {&found, 1});
  };
  snapshot.overlaps = overlaps_in(answer.pairs);
  snapshot.checked = check && answer.difference.has_value();
  if (snapshot.checked) {
    const bool matches = answer.matchesOracle();
    snapshot.oracle_pair_count = matches ? answer.pairs.size() : answer.oracle_pairs.size();
    snapshot.oracle_overlaps = matches ? snapshot.overlaps : overlaps_in(answer.oracle_pairs);
    snapshot.difference = std::move(*answer.difference);
  }
  snapshot.pairs = std::move(answer.pairs);
  snapshot.counters = std::move(answer.counters);
}

std::vector<Pair> sorted(std::span<const Pair> pairs) {
  std::vector<Pair> copy(pairs.begin(), pairs.end());
  std::ranges::sort(copy);
  const auto duplicates = std::ranges::unique(copy);
  copy.erase(duplicates.begin(), duplicates.end());
  return copy;
}

}  // namespace

PairComparison comparePairs(std::span<const Pair> first, std::span<const Pair> second) {
  const std::vector<Pair> a = sorted(first);
  const std::vector<Pair> b = sorted(second);
  PairComparison comparison;
  std::ranges::set_difference(a, b, std::back_inserter(comparison.first_only));
  std::ranges::set_difference(b, a, std::back_inserter(comparison.second_only));
  comparison.both = a.size() - comparison.first_only.size();
  return comparison;
}

std::uint32_t countPresent(std::span<const Aabb> boxes) {
  return static_cast<std::uint32_t>(boxes.size()) -
         static_cast<std::uint32_t>(std::ranges::count_if(boxes, isEmpty));
}

CachedAnswer answerOf(AlgorithmTrack& track, const Frame& frame, bool checked,
                      std::optional<FrameDifference> difference, const SceneInfo& scene,
                      Oracle& oracle) {
  CachedAnswer answer{.pairs = track.answer(),
                      .checked = checked,
                      .difference = std::move(difference),
                      .oracle_pairs = {},
                      .counters = track.report().counters};
  if (answer.difference && !answer.matchesOracle()) {
    const std::span<const Pair> oracle_pairs =
        oracle.pairs(frame.boxes, frame.filterIn(scene), scene.periodic);
    answer.oracle_pairs.assign(oracle_pairs.begin(), oracle_pairs.end());
  }
  return answer;
}

std::shared_ptr<const Snapshot> captureSnapshot(const SnapshotRequest& request, Oracle& oracle) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->source = request.source;
  snapshot->scene = request.provider.scene();
  snapshot->frame = request.frame;
  snapshot->trails = trailsOf(request);
  if (request.frame > 0) {
    snapshot->boxes_before = copyOf(request.provider.at(request.frame - 1).boxes);
  }
  const Frame provided = request.provider.at(request.frame);
  snapshot->boxes = copyOf(provided.boxes);
  snapshot->present = countPresent(*snapshot->boxes);
  snapshot->scene.filter = provided.filterIn(request.provider.scene());
  Frame frame{request.frame, *snapshot->boxes};
  if (snapshot->scene.filter_changes) frame.filter = &snapshot->scene.filter;
  AlgorithmTrack* const track = request.track;
  const int number = track != nullptr ? track->spec().number : 0;
  CachedAnswer answer;
  if (track != nullptr && track->isAt(request.frame)) {
    std::optional<FrameDifference> difference;
    if (request.check) difference = track->check(frame, oracle);
    answer = answerOf(*track, frame, request.check, std::move(difference), snapshot->scene, oracle);
    if (request.structure && track->isAt(request.frame)) {
      snapshot->structure = std::make_shared<RecordedDrawing>(track->structure());
    }
    if (!track->isAt(request.frame)) return nullptr;
    snapshot->track = number;
    if (request.cache != nullptr) request.cache->insert(number, request.frame, answer);
  } else if (track != nullptr && request.cache != nullptr &&
             request.cache->contains(number, request.frame, request.check)) {
    snapshot->track = number;
    answer = *request.cache->find(number, request.frame);
  } else {
    answer = oracleAnswer(request, frame, oracle);
  }
  applyAnswer(std::move(answer), request.check, *snapshot);
  return snapshot;
}

}  // namespace broadmark
