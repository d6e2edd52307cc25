#include "inspector/run/snapshot.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace broadmark {
namespace {

/// How many frames of a tracked body are looked back at.
constexpr std::uint32_t kTrackFrames = 60;

std::vector<Track> tracksOf(const SnapshotWish& wish) {
  std::vector<Track> tracks;
  const std::uint32_t first = wish.frame - std::min(wish.frame, kTrackFrames - 1);
  for (const std::uint32_t body : wish.tracked) {
    if (body < wish.footage.scene().objects) tracks.push_back({.body = body, .first = first});
  }
  if (tracks.empty()) return tracks;
  for (std::uint32_t index = first; index <= wish.frame; ++index) {
    const Frame past = wish.footage.at(index);
    for (Track& track : tracks) track.boxes.push_back(past.boxes[track.body]);
  }
  return tracks;
}

std::shared_ptr<const std::vector<Aabb>> boxesOf(FrameProvider& footage, std::uint32_t index) {
  const Frame frame = footage.at(index);
  return std::make_shared<const std::vector<Aabb>>(frame.boxes.begin(), frame.boxes.end());
}

SeenAnswer oraclesAnswer(const SnapshotWish& wish, const Frame& frame, Oracle& oracle) {
  if (wish.seen != nullptr) {
    if (auto seen = wish.seen->recall(0, frame.index)) return std::move(*seen);
  }
  const std::span<const Pair> pairs = oracle.pairs(frame.boxes, wish.footage.scene().filter);
  SeenAnswer answer{.pairs = {pairs.begin(), pairs.end()}, .judged = true};
  if (wish.seen != nullptr) wish.seen->remember(0, frame.index, answer);
  return answer;
}

/// What follows from an answer; the boxes are there already.
void takeAnswer(SeenAnswer answer, bool check, Snapshot& snapshot) {
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

SeenAnswer answerOf(AlgorithmTrack& lane, const Frame& frame, bool judged,
                    std::optional<FrameDifference> difference, const CollisionFilter& filter,
                    Oracle& oracle) {
  SeenAnswer answer{.pairs = lane.answer(),
                    .judged = judged,
                    .difference = std::move(difference),
                    .right = {},
                    .counters = lane.report().counters};
  if (answer.difference && !answer.agrees()) {
    const std::span<const Pair> right = oracle.pairs(frame.boxes, filter);
    answer.right.assign(right.begin(), right.end());
  }
  return answer;
}

std::shared_ptr<const Snapshot> takeSnapshot(const SnapshotWish& wish, Oracle& oracle) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->footage = wish.request;
  snapshot->scene = wish.footage.scene();
  snapshot->frame = wish.frame;
  snapshot->tracks = tracksOf(wish);
  if (wish.frame > 0) snapshot->boxes_before = boxesOf(wish.footage, wish.frame - 1);
  snapshot->boxes = boxesOf(wish.footage, wish.frame);
  snapshot->present = presentIn(*snapshot->boxes);
  const Frame frame{wish.frame, *snapshot->boxes};
  AlgorithmTrack* const lane = wish.lane;
  const int number = lane != nullptr ? lane->spec().number : 0;
  SeenAnswer answer;
  if (lane != nullptr && lane->standsAt(wish.frame)) {
    std::optional<FrameDifference> difference;
    if (wish.check) difference = lane->check(frame, oracle);
    answer =
        answerOf(*lane, frame, wish.check, std::move(difference), snapshot->scene.filter, oracle);
    if (wish.structure && lane->standsAt(wish.frame)) {
      snapshot->structure = std::make_shared<RecordedDrawing>(lane->structure());
    }
    if (!lane->standsAt(wish.frame)) return nullptr;
    snapshot->lane = number;
    if (wish.seen != nullptr) wish.seen->remember(number, wish.frame, answer);
  } else if (lane != nullptr && wish.seen != nullptr &&
             wish.seen->holds(number, wish.frame, wish.check)) {
    snapshot->lane = number;
    answer = *wish.seen->recall(number, wish.frame);
  } else {
    answer = oraclesAnswer(wish, frame, oracle);
  }
  takeAnswer(std::move(answer), wish.check, *snapshot);
  return snapshot;
}

}  // namespace broadmark
