// Frames that have been seen: whose answers are kept, and who has to run them again.
#include "inspector/run/run_thread.h"

namespace broadmark {

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
  if (&lane == shownLane()) return hasSeen(frame) && !current_.structure;
  // Of another one the second view wants the answer itself.
  return !current_.second || current_.second->lane != lane.spec().number;
}

/// Shows a frame that has been seen before any algorithm is run. Returns whether it did.
bool RunThread::lookBack() {
  const std::uint32_t frame = target();
  const Lane* lane = shownLane();
  const bool stands = lane != nullptr && lane->standsAt(frame);
  const bool there = shown_ && progress_.snapshot->frame == frame;
  if (current_.playing || current_.second || stands || there || !hasSeen(frame)) return false;
  show();
  return true;
}

}  // namespace broadmark
