#include "inspector/run/snapshot.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace broadmark {
namespace {

/// How many frames of a trail_bodies body are looked back at.
constexpr std::uint32_t kTrackFrames = 60;

std::vector<Trail> trailsOf(const SnapshotRequest& request) {
  std::vector<Trail> trails;
  const std::uint32_t first = request.frame - std::min(request.frame, kTrackFrames - 1);
  for (const std::uint32_t body : request.trail_bodies) {
    if (body < request.provider.scene().objects) trails.push_back({.body = body, .first = first});
  }
  if (trails.empty()) return trails;
  for (std::uint32_t index = first; index <= request.frame; ++index) {
    const Frame past = request.provider.at(index);
    for (Trail& trail : trails) trail.boxes.push_back(past.boxes[trail.body]);
  }
  return trails;
}

std::shared_ptr<const std::vector<Aabb>> boxesOf(FrameProvider& provider, std::uint32_t index) {
  const Frame frame = provider.at(index);
  return std::make_shared<const std::vector<Aabb>>(frame.boxes.begin(), frame.boxes.end());
}

CachedAnswer oraclesAnswer(const SnapshotRequest& request, const Frame& frame, Oracle& oracle) {
  if (request.seen != nullptr) {
    if (auto seen = request.seen->recall(0, frame.index)) return std::move(*seen);
  }
  const std::span<const Pair> pairs = oracle.pairs(frame.boxes, request.provider.scene().filter);
  CachedAnswer answer{.pairs = {pairs.begin(), pairs.end()}, .judged = true};
  if (request.seen != nullptr) request.seen->remember(0, frame.index, answer);
  return answer;
}

/// What follows from an answer; the boxes are there already.
void takeAnswer(CachedAnswer answer, bool check, Snapshot& snapshot) {
  const auto overlaps_in = [&](const PairRun& found) {
    return overlapCounts(snapshot.boxes->size(), {&found, 1});
  };
  snapshot.overlaps = overlaps_in(answer.pairs);
  snapshot.checked = check && answer.difference.has_value();
  if (snapshot.checked) {
    const bool same = answer.agrees();
    snapshot.right_pairs = same ? answer.pairs.size() : answer.right.size();
    snapshot.right_overlaps = same ? snapshot.overlaps : overlaps_in(answer.right);
    snapshot.difference = std::move(*answer.difference);
  }
  snapshot.pairs = std::move(answer.pairs);
  snapshot.counters = std::move(answer.counters);
}

std::vector<Pair> sorted(std::span<const Pair> pairs) {
  std::vector<Pair> copy(pairs.begin(), pairs.end());
  std::ranges::sort(copy);
  const auto twice = std::ranges::unique(copy);
  copy.erase(twice.begin(), twice.end());
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

std::uint32_t presentIn(std::span<const Aabb> boxes) {
  return static_cast<std::uint32_t>(boxes.size()) -
         static_cast<std::uint32_t>(std::ranges::count_if(boxes, isEmpty));
}

CachedAnswer answerOf(AlgorithmTrack& track, const Frame& frame, bool judged,
                      std::optional<FrameDifference> difference, const CollisionFilter& filter,
                      Oracle& oracle) {
  CachedAnswer answer{.pairs = track.answer(),
                      .judged = judged,
                      .difference = std::move(difference),
                      .right = {},
                      .counters = track.report().counters};
  if (answer.difference && !answer.agrees()) {
    const std::span<const Pair> right = oracle.pairs(frame.boxes, filter);
    answer.right.assign(right.begin(), right.end());
  }
  return answer;
}

std::shared_ptr<const Snapshot> takeSnapshot(const SnapshotRequest& request, Oracle& oracle) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->source = request.source;
  snapshot->scene = request.provider.scene();
  snapshot->frame = request.frame;
  snapshot->trails = trailsOf(request);
  if (request.frame > 0) snapshot->boxes_before = boxesOf(request.provider, request.frame - 1);
  snapshot->boxes = boxesOf(request.provider, request.frame);
  snapshot->present = presentIn(*snapshot->boxes);
  const Frame frame{request.frame, *snapshot->boxes};
  AlgorithmTrack* const track = request.track;
  const int number = track != nullptr ? track->spec().number : 0;
  CachedAnswer answer;
  if (track != nullptr && track->standsAt(request.frame)) {
    std::optional<FrameDifference> difference;
    if (request.check) difference = track->check(frame, oracle);
    answer = answerOf(*track, frame, request.check, std::move(difference), snapshot->scene.filter,
                      oracle);
    if (request.structure && track->standsAt(request.frame)) {
      snapshot->structure = std::make_shared<RecordedDrawing>(track->structure());
    }
    if (!track->standsAt(request.frame)) return nullptr;
    snapshot->track = number;
    if (request.seen != nullptr) request.seen->remember(number, request.frame, answer);
  } else if (track != nullptr && request.seen != nullptr &&
             request.seen->holds(number, request.frame, request.check)) {
    snapshot->track = number;
    answer = *request.seen->recall(number, request.frame);
  } else {
    answer = oraclesAnswer(request, frame, oracle);
  }
  takeAnswer(std::move(answer), request.check, *snapshot);
  return snapshot;
}

}  // namespace broadmark
