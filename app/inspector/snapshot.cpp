#include "inspector/snapshot.h"

#include <algorithm>
#include <utility>

#include "broadmark/pair.h"

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

std::shared_ptr<const std::vector<Aabb>> boxesOf(Footage& footage, std::uint32_t index) {
  const Frame frame = footage.at(index);
  return std::make_shared<const std::vector<Aabb>>(frame.boxes.begin(), frame.boxes.end());
}

/// Compares the answer with the oracle's.
void checkAnswer(Lane& lane, const Frame& frame, Oracle& oracle, Snapshot& snapshot) {
  std::optional<FrameDifference> difference = lane.check(frame, oracle);
  if (!difference) return;
  snapshot.checked = true;
  snapshot.difference = std::move(*difference);
  const PairRun right = oracle.pairs(frame.boxes, snapshot.scene.filter);
  snapshot.right_pairs = right.size();
  snapshot.right_overlaps = overlapCounts(snapshot.boxes->size(), {&right, 1});
}

}  // namespace

std::uint32_t presentIn(std::span<const Aabb> boxes) {
  return static_cast<std::uint32_t>(boxes.size()) -
         static_cast<std::uint32_t>(std::ranges::count_if(boxes, isEmpty));
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
  if (Lane* const lane = wish.lane) {
    snapshot->lane = lane->spec().number;
    snapshot->pairs = lane->answer();
    if (wish.check && lane->standsAt(wish.frame)) checkAnswer(*lane, frame, oracle, *snapshot);
    if (wish.structure && lane->standsAt(wish.frame)) {
      snapshot->structure = std::make_shared<RecordedDrawing>(lane->structure());
    }
    if (!lane->standsAt(wish.frame)) return nullptr;
  } else {
    const std::span<const Pair> pairs = oracle.pairs(frame.boxes, snapshot->scene.filter);
    snapshot->pairs.assign(pairs.begin(), pairs.end());
  }
  const PairRun answer = snapshot->pairs;
  snapshot->overlaps = overlapCounts(snapshot->boxes->size(), {&answer, 1});
  return snapshot;
}

}  // namespace broadmark
