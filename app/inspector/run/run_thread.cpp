#include "inspector/run/run_thread.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace broadmark {
namespace {

/// Bodies that all overlap by a mistake should not take all memory: this is half a gigabyte.
constexpr std::size_t kMaxPairs = std::size_t{1} << 26;

/// Whether one wish's snapshot also serves the other.
bool showSame(const ViewRequest& a, const ViewRequest& b) {
  return a.check == b.check && a.shown_lane == b.shown_lane && a.structure == b.structure &&
         a.tracked == b.tracked && a.second == b.second;
}

/// How many pairs overlap, by what an algorithm reported and how wrong that was.
std::uint64_t rightPairs(const FrameRecord& record) {
  const FrameCounts& counts = record.counts;
  return counts[FrameCount::pairs] + counts[FrameCount::missed] - counts[FrameCount::false_pairs] -
         counts[FrameCount::allowed_extra] - counts[FrameCount::invalid];
}

float fractionOf(std::uint32_t part, std::uint32_t whole) {
  return whole == 0 ? 1.0F : static_cast<float>(part) / static_cast<float>(whole);
}

}  // namespace

RunThread::RunThread(ExecutorFactory make_host)
    : make_host_(std::move(make_host)), thread_([this] { loop(); }) {}

RunThread::~RunThread() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void RunThread::wish(ViewRequest wish) {
  {
    const std::lock_guard lock(mutex_);
    wished_ = std::move(wish);
    ++wishes_;
  }
  changed_.notify_all();
}

void RunThread::look(const std::function<void(const RunProgress&)>& at) {
  const std::lock_guard lock(mutex_);
  at(progress_);
}

bool RunThread::isIdle() {
  const std::lock_guard lock(mutex_);
  return idle_ && taken_ == wishes_;
}

bool RunThread::waitUntilIdle(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, patience, [this] { return idle_ && taken_ == wishes_; });
}

void RunThread::loop() {
  std::unique_lock lock(mutex_);
  while (true) {
    if (stopping_) return;
    if (taken_ != wishes_) takeRequest();
    if (idle_) {
      changed_.wait(lock, [this] { return stopping_ || taken_ != wishes_; });
      continue;
    }
    lock.unlock();
    bool more = false;
    try {
      more = step();
    } catch (const Cancelled&) {
      more = true;  // another wish has come
    } catch (const std::exception& error) {
      fail(error.what());
    }
    lock.lock();
    if (more || taken_ != wishes_) continue;
    idle_ = true;
    progress_.doing.clear();
    changed_.notify_all();
  }
}

/// With mutex_ held.
void RunThread::takeRequest() {
  if (!showSame(current_, wished_)) shown_ = false;
  looked_back_ = false;
  // One that rests after the shown frame goes on from there only if it was checked up to there.
  if (wished_.check && footage_) {
    for (const auto& lane : lanes_) lane->requireChecked(target());
  }
  current_ = wished_;
  taken_ = wishes_;
  idle_ = false;
}

/// Does one piece of work; false when there is none left.
bool RunThread::step() {
  if (current_.footage != opened_) {
    openFootage();
    return true;
  }
  if (footage_ == nullptr) return false;
  if (reconcileLanes()) return true;
  if (!std::exchange(looked_back_, true) && showCached()) return true;
  if (advance() || advanceSecond()) return true;
  if (shown_) return false;
  show();
  return true;
}

void RunThread::fail(std::string reason) {
  const std::lock_guard lock(mutex_);
  progress_.failure = std::move(reason);
}

bool RunThread::isUnwanted(const LaneSpec& spec) {
  const std::lock_guard lock(mutex_);
  return stopping_ || wished_.footage != opened_ ||
         std::ranges::find(wished_.lanes, spec) == wished_.lanes.end();
}

bool RunThread::isUnwantedBeside(const LaneSpec& spec) {
  if (isUnwanted(spec)) return true;
  const std::lock_guard lock(mutex_);
  return !wished_.second || wished_.second->lane != spec.number ||
         wished_.second->footage != current_.second->footage;
}

void RunThread::tell(std::string doing, float fraction) {
  const std::lock_guard lock(mutex_);
  progress_.doing = std::move(doing);
  progress_.fraction = fraction;
}

void RunThread::openFootage() {
  tell(current_.footage ? fmt::format("opening {}", current_.footage->title) : "", 0);
  lanes_.clear();
  beside_ = {};
  footage_.reset();
  oracle_ = Oracle(std::size_t{256} << 20, kMaxPairs);
  seen_.clear();
  stop_.reset();
  shown_ = false;
  opened_ = current_.footage;
  std::string failure;
  try {
    if (opened_) footage_ = opened_->open();
  } catch (const std::exception& error) {
    failure = error.what();
  }
  const std::lock_guard lock(mutex_);
  progress_ = RunProgress{.footage = opened_, .failure = std::move(failure)};
  if (footage_ == nullptr) return;
  progress_.scene = footage_->scene();
  progress_.known_frames = footage_->known();
  progress_.live = footage_->live();
  progress_.frames = footage_->opener();
}

/// Brings the lanes in line with those wished for. Returns whether there was anything to do.
bool RunThread::reconcileLanes() {
  const auto spec_of = [](const auto& lane) -> const LaneSpec& { return lane->spec(); };
  if (std::ranges::equal(lanes_, current_.lanes, {}, spec_of)) return false;

  std::vector<std::unique_ptr<AlgorithmTrack>> kept = std::move(lanes_);
  lanes_.clear();
  for (const LaneSpec& spec : current_.lanes) {
    const auto found =
        std::ranges::find_if(kept, [&](const auto& lane) { return lane && lane->spec() == spec; });
    lanes_.push_back(found != kept.end()
                         ? std::move(*found)
                         : std::make_unique<AlgorithmTrack>(
                               spec, make_host_, [this, spec] { return isUnwanted(spec); }));
  }
  for (const auto& gone : kept) {
    if (gone) seen_.forget(gone->spec().number);
  }
  kept.clear();
  shown_ = false;
  stop_.reset();
  const std::lock_guard lock(mutex_);
  progress_.stop.reset();
  progress_.lanes.clear();
  for (const auto& lane : lanes_) progress_.lanes.push_back(lane->report());
  return true;
}

std::uint32_t RunThread::target() const {
  const std::uint32_t last = std::min(current_.frame, footage_->scene().frames);
  return stop_ ? std::min(last, stop_->frame) : last;
}

/// A frame of the footage; takes note of its population.
Frame RunThread::frameAt(std::uint32_t index) {
  const Frame frame = footage_->at(index);
  notePopulation(index, frame.boxes);
  return frame;
}

void RunThread::notePopulation(std::uint32_t index, std::span<const Aabb> boxes) {
  if (footage_->scene().all_present) return;
  const auto present = static_cast<float>(presentIn(boxes));
  const std::lock_guard lock(mutex_);
  progress_.population.set(index, present);
}

/// Brings the footage and one lane a frame nearer to the target. Returns whether it had to.
bool RunThread::advance() {
  if (stop_ && (!current_.check || !current_.stop_at_mismatch ||
                (current_.known_mismatch && *current_.known_mismatch >= stop_->frame))) {
    stop_.reset();
    const std::lock_guard lock(mutex_);
    progress_.stop.reset();
  }
  const bool shares = current_.second && !current_.second->footage;
  const std::uint32_t beside = shares ? current_.second->frame.value_or(0) : 0;
  const std::uint32_t wanted = std::max(target(), std::min(beside, footage_->scene().frames));
  if (footage_->known() < wanted) {
    tell(fmt::format("simulating frame {}", footage_->known() + 1),
         fractionOf(footage_->known(), wanted));
    footage_->extend();
    if (!footage_->scene().all_present) frameAt(footage_->known());
    const std::lock_guard lock(mutex_);
    progress_.known_frames = footage_->known();
    return true;
  }
  // The hindmost first: then all pass each frame before any goes on.
  AlgorithmTrack* hindmost = nullptr;
  for (const auto& lane : lanes_) {
    if (lane->report().ended || lane->standsAt(target()) || isCached(*lane)) continue;
    const bool restarts = lane->report().frame > target() || !lane->standsAt(lane->report().frame);
    if (restarts) {
      lane->restart(footage_->scene(), footage_->at(0));
      report(*lane);
      shown_ = false;
      return true;
    }
    if (hindmost == nullptr || lane->report().frame < hindmost->report().frame) {
      hindmost = lane.get();
    }
  }
  if (hindmost == nullptr) {
    const std::lock_guard lock(mutex_);
    if (!progress_.snapshot || progress_.snapshot->footage != opened_ ||
        progress_.snapshot->frame != target()) {
      shown_ = false;
    }
    return false;
  }
  const std::uint32_t next = hindmost->report().frame + 1;
  const std::string& id = hindmost->spec().run.algorithm.id;
  tell(hindmost->report().record(next) != nullptr
           ? fmt::format("running {} again up to frame {}", id, target())
           : fmt::format("{}: frame {}", id, next),
       fractionOf(next, target()));
  return advanceLane(*hindmost, frameAt(next));
}

bool RunThread::advanceLane(AlgorithmTrack& lane, const Frame& frame) {
  shown_ = false;
  lane.advance(frame, gate_);
  std::optional<FrameDifference> difference;
  if (current_.check && lane.standsAt(frame.index)) {
    difference = lane.check(frame, oracle_);
    const bool known = current_.known_mismatch && frame.index <= *current_.known_mismatch;
    if (difference && difference->isMismatch() && !known && current_.stop_at_mismatch &&
        (!stop_ || frame.index < stop_->frame)) {
      stop_ = RunProgress::Stop{.frame = frame.index, .lane = lane.spec().number};
      const std::lock_guard lock(mutex_);
      progress_.stop = stop_;
    }
  }
  // show() asks at the target.
  if (&lane == shownLane() && frame.index != target() && lane.standsAt(frame.index) &&
      !hasSeen(frame.index)) {
    const SeenAnswer answer = answerOf(lane, frame, current_.check, std::move(difference),
                                       footage_->scene().filter, oracle_);
    if (lane.standsAt(frame.index)) seen_.remember(lane.spec().number, frame.index, answer);
  }
  report(lane);
  return true;
}

void RunThread::report(const AlgorithmTrack& lane) {
  const LaneReport& now = lane.report();
  const std::lock_guard lock(mutex_);
  const auto shown = std::ranges::find(progress_.lanes, now.spec.number,
                                       [](const LaneReport& report) { return report.spec.number; });
  if (shown == progress_.lanes.end()) return;
  static_cast<LaneState&>(*shown) = now;
  // The history changes at the present frame only, and is too long to be copied every time.
  shown->frames.resize(now.frames.size());
  if (now.frame == 0) return;
  const FrameRecord& record = now.frames[now.frame - 1];
  shown->frames[now.frame - 1] = record;
  shown->curves.set(now.frame, record);
  if (now.spec.run.answer == AnswerKind::pairs && now.spec.run.algorithm.traits.finds_pairs) {
    progress_.pairs.set(now.frame, static_cast<float>(rightPairs(record)));
  }
}

AlgorithmTrack* RunThread::laneOf(int number) const {
  const auto found =
      std::ranges::find(lanes_, number, [](const auto& lane) { return lane->spec().number; });
  return found == lanes_.end() ? nullptr : found->get();
}

AlgorithmTrack* RunThread::shownLane() const {
  return target() > 0 ? laneOf(current_.shown_lane) : nullptr;
}

FrameProvider* RunThread::footageBeside() const {
  return beside_.opened ? beside_.footage.get() : footage_.get();
}

std::uint32_t RunThread::targetBeside() const {
  return std::min(current_.second->frame.value_or(target()), footageBeside()->scene().frames);
}

AlgorithmTrack* RunThread::laneBeside() {
  AlgorithmTrack* const of_first = laneOf(current_.second->lane);
  if (of_first == nullptr) {
    beside_.lane.reset();
    return nullptr;
  }
  if (targetBeside() == 0) return nullptr;  // which has no answer
  if (!beside_.opened && targetBeside() == target()) return of_first;
  if (const LaneSpec& spec = of_first->spec(); !beside_.lane || beside_.lane->spec() != spec) {
    beside_.lane = std::make_unique<AlgorithmTrack>(
        spec, make_host_, [this, spec] { return isUnwantedBeside(spec); });
  }
  return beside_.lane.get();
}

/// Brings what the second view shows nearer to what it is to be. Returns whether it had to.
bool RunThread::advanceSecond() {
  if (!current_.second) return false;
  if (const auto& wanted = current_.second->footage; wanted != beside_.opened) {
    tell(fmt::format("opening {}", wanted ? wanted->title : ""), 1);
    shown_ = false;
    beside_ = {.opened = wanted};
    try {
      if (wanted) beside_.footage = wanted->open();
    } catch (const std::exception& error) {
      beside_.failure = error.what();
    }
    return true;
  }
  FrameProvider* const footage = footageBeside();
  if (footage == nullptr) return false;
  if (footage->known() < targetBeside()) {
    tell(fmt::format("simulating frame {} for the second view", footage->known() + 1), 1);
    footage->extend();
    shown_ = false;
    return true;
  }
  AlgorithmTrack* const lane = laneBeside();
  if (lane == nullptr || lane != beside_.lane.get()) return false;  // advance() sees to it
  const std::uint32_t frame = lane->report().frame;
  if (lane->report().ended || lane->standsAt(targetBeside())) return false;
  tell(fmt::format("{} for the second view: frame {}", lane->spec().run.algorithm.id, frame + 1),
       1);
  shown_ = false;
  if (frame > targetBeside() || !lane->standsAt(frame)) {
    lane->restart(footage->scene(), footage->at(0));
  } else {
    lane->advance(footage->at(frame + 1), gate_);
  }
  return true;
}

std::shared_ptr<const Snapshot> RunThread::takeBeside() {
  return takeSnapshot({.request = beside_.opened ? beside_.opened : opened_,
                       .footage = *footageBeside(),
                       .frame = targetBeside(),
                       .lane = laneBeside(),
                       .check = current_.check,
                       .structure = current_.structure,
                       .tracked = current_.tracked},
                      oracle_beside_);
}

void RunThread::show() {
  const std::uint32_t index = target();
  const auto snapshot = takeSnapshot({.request = opened_,
                                      .footage = *footage_,
                                      .frame = index,
                                      .lane = shownLane(),
                                      .seen = &seen_,
                                      .check = current_.check,
                                      .structure = current_.structure,
                                      .tracked = current_.tracked},
                                     oracle_);
  if (!current_.second) beside_ = {};
  const bool wants_second = current_.second && footageBeside() != nullptr;
  const auto second = snapshot && wants_second ? takeBeside() : nullptr;
  if (!snapshot || (wants_second && !second)) {  // a lane was lost on the way: shown without it
    for (const auto& one : lanes_) report(*one);
    return;
  }
  if (index > 0) notePopulation(index - 1, *snapshot->boxes_before);
  notePopulation(index, *snapshot->boxes);
  std::shared_ptr<const PairComparison> comparison;
  if (second) {
    comparison =
        std::make_shared<const PairComparison>(comparePairs(snapshot->pairs, second->pairs));
  }
  shown_ = true;
  const std::lock_guard lock(mutex_);
  if (snapshot->lane == 0) progress_.pairs.set(index, static_cast<float>(snapshot->pairs.size()));
  progress_.snapshot = snapshot;
  progress_.second = second;
  progress_.comparison = std::move(comparison);
  progress_.second_failure = beside_.failure;
}

bool RunThread::hasSeen(std::uint32_t frame) const {
  if (const AlgorithmTrack* lane = shownLane()) {
    return seen_.holds(lane->spec().number, frame, current_.check);
  }
  return seen_.holds(0, frame, false);
}

bool RunThread::isCached(const AlgorithmTrack& lane) const {
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
bool RunThread::showCached() {
  const std::uint32_t frame = target();
  const AlgorithmTrack* lane = shownLane();
  const bool stands = lane != nullptr && lane->standsAt(frame);
  const bool there = shown_ && progress_.snapshot->frame == frame;
  if (current_.playing || current_.second || stands || there || !hasSeen(frame)) return false;
  show();
  return true;
}

}  // namespace broadmark
