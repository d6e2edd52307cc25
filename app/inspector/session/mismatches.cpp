#include "inspector/session/mismatches.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "inspector/session/wrong_pair.h"

namespace broadmark {

void Mismatches::advance(const RunProgress& progress) {
  noticeStop(progress);
  if (!playback_.hasReached(progress)) return;
  visitStop(*progress.snapshot);
  if (std::exchange(searching_, false)) {
    notices_.say(fmt::format("no further mismatch up to frame {}", playback_.frame()));
  }
}

void Mismatches::noticeStop(const RunProgress& progress) {
  if (!progress.stop) {
    noticed_.reset();
    return;
  }
  const auto [frame, number] = *progress.stop;
  const bool is_known = known_ && *known_ >= frame;
  if (is_known || (noticed_ && noticed_->frame == frame)) return;
  playback_.goTo(frame);
  lanes_.show(number);
  noticed_ = to_visit_ = progress.stop;
  notices_.bringUp("Mismatches");
  const LaneEdit* wrong = lanes_.find(number);
  notices_.say(
      fmt::format("{} is wrong in frame {}", wrong ? wrong->algorithm.id : "an algorithm", frame),
      Message::Kind::error);
}

void Mismatches::visitStop(const Snapshot& seen) {
  if (!to_visit_ || !seen.checked || seen.frame != to_visit_->frame ||
      seen.lane != to_visit_->lane) {
    return;
  }
  to_visit_.reset();
  const std::vector<WrongPair> wrong = wrongPairs(seen.difference);
  if (!wrong.empty()) selection_.visit(wrong.front().pair);
}

void Mismatches::goToNext(const RunProgress& progress) {
  playback_.pause();
  check = stop_at_mismatch = true;
  if (const auto next = nextKnownMismatch(progress.lanes, playback_.frame())) {
    playback_.seek(next->frame);
    lanes_.show(next->lane);
    return;
  }
  playback_.seek(playback_.lastFrame());
  searching_ = true;
}

void Mismatches::endSearch(const RunProgress& progress) {
  std::uint32_t reached = progress.snapshot ? progress.snapshot->frame : 0;
  for (const LaneReport& lane : progress.lanes) reached = std::max(reached, lane.frame);
  playback_.seek(std::min(reached, playback_.frame()));
}

void Mismatches::moved(bool forward) {
  if (forward && noticed_) known_ = noticed_->frame;
  searching_ = false;
}

void Mismatches::forgetStop() {
  known_.reset();
  noticed_.reset();
}

void Mismatches::reset() {
  forgetStop();
  to_visit_.reset();
  searching_ = false;
}

std::optional<RunProgress::Stop> nextKnownMismatch(const std::vector<LaneReport>& lanes,
                                                   std::uint32_t frame) {
  std::optional<RunProgress::Stop> next;
  for (const LaneReport& lane : lanes) {
    for (std::uint32_t index = frame + 1; index <= lane.frames.size(); ++index) {
      if (!lane.frames[index - 1].mismatch) continue;
      if (!next || index < next->frame) next = {.frame = index, .lane = lane.spec.number};
      break;
    }
  }
  return next;
}

}  // namespace broadmark
