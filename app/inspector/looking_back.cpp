// Frames that have been seen: what is kept of their answers, and who has to run them again.
#include <utility>

#include "broadmark/pair.h"
#include "inspector/run_thread.h"

namespace broadmark {

void Snapshot::take(SeenAnswer answer, bool check) {
  const auto overlapsIn = [this](const PairRun& found) {
    return overlapCounts(boxes->size(), {&found, 1});
  };
  overlaps = overlapsIn(answer.pairs);
  checked = check && answer.difference.has_value();
  if (checked) {
    const bool same = answer.agrees();
    right_pairs = same ? answer.pairs.size() : answer.right.size();
    right_overlaps = same ? overlaps : overlapsIn(answer.right);
    difference = std::move(*answer.difference);
  }
  pairs = std::move(answer.pairs);
  counters = std::move(answer.counters);
}

bool RunThread::hasSeen(std::uint32_t frame) const {
  if (const Lane* lane = shownLane()) {
    return seen_.holds(lane->spec().number, frame, current_.check);
  }
  return seen_.holds(0, frame, false);
}

bool RunThread::mayRest(const Lane& lane) const {
  if (current_.playing) return false;
  const std::uint32_t frame = target();
  if (frame == 0) return lane.standsAt(lane.report().frame);
  const FrameRecord* record = lane.report().record(frame);
  const bool judges = current_.check && lane.spec().run.algorithm.traits.finds_pairs;
  if (record == nullptr || (judges && !record->checked)) return false;
  return &lane != shownLane() || (hasSeen(frame) && !current_.structure);
}

/// Shows a frame that has been seen before any algorithm is run. Returns whether it did.
bool RunThread::lookBack() {
  const std::uint32_t frame = target();
  const Lane* lane = shownLane();
  const bool stands = lane != nullptr && lane->standsAt(frame);
  const bool there = shown_ && progress_.snapshot->frame == frame;
  if (current_.playing || stands || there || !hasSeen(frame)) return false;
  show();
  return true;
}

/// Of a lane that stands at this frame, with what has been found wrong.
SeenAnswer RunThread::answerOf(Lane& lane, const Frame& frame,
                               std::optional<FrameDifference> difference) {
  SeenAnswer answer{.pairs = lane.answer(),
                    .judged = current_.check,
                    .difference = std::move(difference),
                    .right = {},
                    .counters = lane.report().counters};
  if (answer.difference && !answer.agrees()) {
    const std::span<const Pair> right = oracle_.pairs(frame.boxes, footage_->scene().filter);
    answer.right.assign(right.begin(), right.end());
  }
  return answer;
}

SeenAnswer RunThread::oraclesAnswer(const Frame& frame) {
  if (auto seen = seen_.recall(0, frame.index)) return std::move(*seen);
  const std::span<const Pair> pairs = oracle_.pairs(frame.boxes, footage_->scene().filter);
  SeenAnswer answer{.pairs = {pairs.begin(), pairs.end()}, .judged = true};
  seen_.remember(0, frame.index, answer);
  return answer;
}

}  // namespace broadmark
