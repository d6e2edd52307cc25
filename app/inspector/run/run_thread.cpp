#include "inspector/run/run_thread.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace broadmark {
namespace {

/// Bodies that all overlap by a mistake should not take all memory: this is half a gigabyte.
constexpr std::size_t kMaxPairs = std::size_t{1} << 26;

/// Whether a snapshot for either request also serves the other.
bool showSame(const ViewRequest& a, const ViewRequest& b) {
  return a.check == b.check && a.shown_track == b.shown_track && a.structure == b.structure &&
         a.trail_bodies == b.trail_bodies && a.second == b.second;
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

void RunThread::request(ViewRequest request) {
  {
    const std::lock_guard lock(mutex_);
    requested_ = std::move(request);
    ++requests_;
  }
  changed_.notify_all();
}

void RunThread::readProgress(const std::function<void(const RunProgress&)>& at) {
  const std::lock_guard lock(mutex_);
  at(progress_);
}

bool RunThread::isIdle() {
  const std::lock_guard lock(mutex_);
  return idle_ && taken_ == requests_;
}

bool RunThread::waitUntilIdle(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, patience, [this] { return idle_ && taken_ == requests_; });
}

void RunThread::loop() {
  std::unique_lock lock(mutex_);
  while (true) {
    if (stopping_) return;
    if (taken_ != requests_) takeRequest();
    if (idle_) {
      changed_.wait(lock, [this] { return stopping_ || taken_ != requests_; });
      continue;
    }
    lock.unlock();
    bool more = false;
    try {
      more = step();
    } catch (const Cancelled&) {
      more = true;  // another request has come
    } catch (const std::exception& error) {
      fail(error.what());
    }
    lock.lock();
    if (more || taken_ != requests_) continue;
    idle_ = true;
    progress_.doing.clear();
    changed_.notify_all();
  }
}

/// With mutex_ held.
void RunThread::takeRequest() {
  if (!showSame(current_, requested_)) shown_ = false;
  looked_back_ = false;
  // A track beyond the shown frame continues from there only if it was checked up to there.
  if (requested_.check && provider_) {
    for (const auto& track : tracks_) track->requireChecked(target());
  }
  current_ = requested_;
  taken_ = requests_;
  idle_ = false;
}

/// Runs the next unit of work; false when there is none left.
bool RunThread::step() {
  if (current_.source != opened_) {
    openSource();
    return true;
  }
  if (provider_ == nullptr) return false;
  if (updateTracks()) return true;
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

bool RunThread::isUnwanted(const TrackSpec& spec) {
  const std::lock_guard lock(mutex_);
  return stopping_ || requested_.source != opened_ ||
         std::ranges::find(requested_.tracks, spec) == requested_.tracks.end();
}

bool RunThread::isUnwantedInSecond(const TrackSpec& spec) {
  if (isUnwanted(spec)) return true;
  const std::lock_guard lock(mutex_);
  return !requested_.second || requested_.second->track != spec.number ||
         requested_.second->source != current_.second->source;
}

void RunThread::setActivity(std::string doing, float fraction) {
  const std::lock_guard lock(mutex_);
  progress_.doing = std::move(doing);
  progress_.fraction = fraction;
}

void RunThread::openSource() {
  setActivity(current_.source ? fmt::format("opening {}", current_.source->title) : "", 0);
  tracks_.clear();
  second_ = {};
  provider_.reset();
  oracle_ = Oracle(std::size_t{256} << 20, kMaxPairs);
  cache_.clear();
  stop_.reset();
  shown_ = false;
  opened_ = current_.source;
  std::string failure;
  try {
    if (opened_) provider_ = opened_->open();
  } catch (const std::exception& error) {
    failure = error.what();
  }
  const std::lock_guard lock(mutex_);
  progress_ = RunProgress{.source = opened_, .failure = std::move(failure)};
  if (provider_ == nullptr) return;
  progress_.scene = provider_->scene();
  progress_.known_frames = provider_->known();
  progress_.live = provider_->live();
  progress_.frames = provider_->opener();
}

/// Adds and removes tracks to match the request. Returns whether any had changed.
bool RunThread::updateTracks() {
  const auto spec_of = [](const auto& track) -> const TrackSpec& { return track->spec(); };
  if (std::ranges::equal(tracks_, current_.tracks, {}, spec_of)) return false;

  std::vector<std::unique_ptr<AlgorithmTrack>> kept = std::move(tracks_);
  tracks_.clear();
  for (const TrackSpec& spec : current_.tracks) {
    const auto found = std::ranges::find_if(
        kept, [&](const auto& track) { return track && track->spec() == spec; });
    tracks_.push_back(found != kept.end()
                          ? std::move(*found)
                          : std::make_unique<AlgorithmTrack>(
                                spec, make_host_, [this, spec] { return isUnwanted(spec); }));
  }
  for (const auto& gone : kept) {
    if (gone) cache_.forget(gone->spec().number);
  }
  kept.clear();
  shown_ = false;
  stop_.reset();
  const std::lock_guard lock(mutex_);
  progress_.stop.reset();
  progress_.tracks.clear();
  for (const auto& track : tracks_) progress_.tracks.push_back(track->report());
  return true;
}

std::uint32_t RunThread::target() const {
  const std::uint32_t last = std::min(current_.frame, provider_->scene().frames);
  return stop_ ? std::min(last, stop_->frame) : last;
}

/// Reads a frame of the source and records its population.
Frame RunThread::frameAt(std::uint32_t index) {
  const Frame frame = provider_->at(index);
  notePopulation(index, frame.boxes);
  return frame;
}

void RunThread::notePopulation(std::uint32_t index, std::span<const Aabb> boxes) {
  if (provider_->scene().all_present) return;
  const auto present = static_cast<float>(presentIn(boxes));
  const std::lock_guard lock(mutex_);
  progress_.population.set(index, present);
}

/// Brings the source and one track a frame nearer to the target. Returns whether it had to.
bool RunThread::advance() {
  if (stop_ && (!current_.check || !current_.stop_at_mismatch ||
                (current_.known_mismatch && *current_.known_mismatch >= stop_->frame))) {
    stop_.reset();
    const std::lock_guard lock(mutex_);
    progress_.stop.reset();
  }
  const bool shares = current_.second && !current_.second->source;
  const std::uint32_t beside = shares ? current_.second->frame.value_or(0) : 0;
  const std::uint32_t wanted = std::max(target(), std::min(beside, provider_->scene().frames));
  if (provider_->known() < wanted) {
    setActivity(fmt::format("simulating frame {}", provider_->known() + 1),
                fractionOf(provider_->known(), wanted));
    provider_->extend();
    if (!provider_->scene().all_present) frameAt(provider_->known());
    const std::lock_guard lock(mutex_);
    progress_.known_frames = provider_->known();
    return true;
  }
  // The hindmost first: then all pass each frame before any goes on.
  AlgorithmTrack* hindmost = nullptr;
  for (const auto& track : tracks_) {
    if (track->report().ended || track->standsAt(target()) || isCached(*track)) continue;
    const bool restarts =
        track->report().frame > target() || !track->standsAt(track->report().frame);
    if (restarts) {
      track->restart(provider_->scene(), provider_->at(0));
      report(*track);
      shown_ = false;
      return true;
    }
    if (hindmost == nullptr || track->report().frame < hindmost->report().frame) {
      hindmost = track.get();
    }
  }
  if (hindmost == nullptr) {
    const std::lock_guard lock(mutex_);
    if (!progress_.snapshot || progress_.snapshot->source != opened_ ||
        progress_.snapshot->frame != target()) {
      shown_ = false;
    }
    return false;
  }
  const std::uint32_t next = hindmost->report().frame + 1;
  const std::string& id = hindmost->spec().test_case.algorithm.id;
  setActivity(hindmost->report().record(next) != nullptr
                  ? fmt::format("running {} again up to frame {}", id, target())
                  : fmt::format("{}: frame {}", id, next),
              fractionOf(next, target()));
  return advanceTrack(*hindmost, frameAt(next));
}

bool RunThread::advanceTrack(AlgorithmTrack& track, const Frame& frame) {
  shown_ = false;
  track.advance(frame, gate_);
  std::optional<FrameDifference> difference;
  if (current_.check && track.standsAt(frame.index)) {
    difference = track.check(frame, oracle_);
    const bool known = current_.known_mismatch && frame.index <= *current_.known_mismatch;
    if (difference && difference->isMismatch() && !known && current_.stop_at_mismatch &&
        (!stop_ || frame.index < stop_->frame)) {
      stop_ = RunProgress::Stop{.frame = frame.index, .track = track.spec().number};
      const std::lock_guard lock(mutex_);
      progress_.stop = stop_;
    }
  }
  // show() asks at the target.
  if (&track == shownTrack() && frame.index != target() && track.standsAt(frame.index) &&
      !isAnswerCached(frame.index)) {
    const CachedAnswer answer = answerOf(track, frame, current_.check, std::move(difference),
                                         provider_->scene().filter, oracle_);
    if (track.standsAt(frame.index)) cache_.remember(track.spec().number, frame.index, answer);
  }
  report(track);
  return true;
}

void RunThread::report(const AlgorithmTrack& track) {
  const TrackReport& now = track.report();
  const std::lock_guard lock(mutex_);
  const auto shown =
      std::ranges::find(progress_.tracks, now.spec.number,
                        [](const TrackReport& report) { return report.spec.number; });
  if (shown == progress_.tracks.end()) return;
  static_cast<TrackState&>(*shown) = now;
  // The history changes at the present frame only, and is too long to be copied every time.
  shown->frames.resize(now.frames.size());
  if (now.frame == 0) return;
  const FrameRecord& record = now.frames[now.frame - 1];
  shown->frames[now.frame - 1] = record;
  shown->curves.set(now.frame, record);
  if (now.spec.test_case.answer == AnswerKind::pairs &&
      now.spec.test_case.algorithm.traits.finds_pairs) {
    progress_.pairs.set(now.frame, static_cast<float>(rightPairs(record)));
  }
}

AlgorithmTrack* RunThread::trackOf(int number) const {
  const auto found =
      std::ranges::find(tracks_, number, [](const auto& track) { return track->spec().number; });
  return found == tracks_.end() ? nullptr : found->get();
}

AlgorithmTrack* RunThread::shownTrack() const {
  return target() > 0 ? trackOf(current_.shown_track) : nullptr;
}

FrameProvider* RunThread::secondProvider() const {
  return second_.opened ? second_.provider.get() : provider_.get();
}

std::uint32_t RunThread::secondTarget() const {
  return std::min(current_.second->frame.value_or(target()), secondProvider()->scene().frames);
}

AlgorithmTrack* RunThread::secondTrack() {
  AlgorithmTrack* const of_first = trackOf(current_.second->track);
  if (of_first == nullptr) {
    second_.track.reset();
    return nullptr;
  }
  if (secondTarget() == 0) return nullptr;  // which has no answer
  if (!second_.opened && secondTarget() == target()) return of_first;
  if (const TrackSpec& spec = of_first->spec(); !second_.track || second_.track->spec() != spec) {
    second_.track = std::make_unique<AlgorithmTrack>(
        spec, make_host_, [this, spec] { return isUnwantedInSecond(spec); });
  }
  return second_.track.get();
}

/// Brings what the second view shows nearer to what it is to be. Returns whether it had to.
bool RunThread::advanceSecond() {
  if (!current_.second) return false;
  if (const auto& wanted = current_.second->source; wanted != second_.opened) {
    setActivity(fmt::format("opening {}", wanted ? wanted->title : ""), 1);
    shown_ = false;
    second_ = {.opened = wanted};
    try {
      if (wanted) second_.provider = wanted->open();
    } catch (const std::exception& error) {
      second_.failure = error.what();
    }
    return true;
  }
  FrameProvider* const provider = secondProvider();
  if (provider == nullptr) return false;
  if (provider->known() < secondTarget()) {
    setActivity(fmt::format("simulating frame {} for the second view", provider->known() + 1), 1);
    provider->extend();
    shown_ = false;
    return true;
  }
  AlgorithmTrack* const track = secondTrack();
  if (track == nullptr || track != second_.track.get()) return false;  // advance() sees to it
  const std::uint32_t frame = track->report().frame;
  if (track->report().ended || track->standsAt(secondTarget())) return false;
  setActivity(fmt::format("{} for the second view: frame {}", track->spec().test_case.algorithm.id,
                          frame + 1),
              1);
  shown_ = false;
  if (frame > secondTarget() || !track->standsAt(frame)) {
    track->restart(provider->scene(), provider->at(0));
  } else {
    track->advance(provider->at(frame + 1), gate_);
  }
  return true;
}

std::shared_ptr<const Snapshot> RunThread::takeSecondSnapshot() {
  return takeSnapshot({.source = second_.opened ? second_.opened : opened_,
                       .provider = *secondProvider(),
                       .frame = secondTarget(),
                       .track = secondTrack(),
                       .check = current_.check,
                       .structure = current_.structure,
                       .trail_bodies = current_.trail_bodies},
                      second_oracle_);
}

void RunThread::show() {
  const std::uint32_t index = target();
  const auto snapshot = takeSnapshot({.source = opened_,
                                      .provider = *provider_,
                                      .frame = index,
                                      .track = shownTrack(),
                                      .seen = &cache_,
                                      .check = current_.check,
                                      .structure = current_.structure,
                                      .trail_bodies = current_.trail_bodies},
                                     oracle_);
  if (!current_.second) second_ = {};
  const bool wants_second = current_.second && secondProvider() != nullptr;
  const auto second = snapshot && wants_second ? takeSecondSnapshot() : nullptr;
  if (!snapshot || (wants_second && !second)) {  // a track was lost on the way: shown without it
    for (const auto& track : tracks_) report(*track);
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
  if (snapshot->track == 0) progress_.pairs.set(index, static_cast<float>(snapshot->pairs.size()));
  progress_.snapshot = snapshot;
  progress_.second = second;
  progress_.comparison = std::move(comparison);
  progress_.second_failure = second_.failure;
}

bool RunThread::isAnswerCached(std::uint32_t frame) const {
  if (const AlgorithmTrack* track = shownTrack()) {
    return cache_.holds(track->spec().number, frame, current_.check);
  }
  return cache_.holds(0, frame, false);
}

bool RunThread::isCached(const AlgorithmTrack& track) const {
  if (current_.playing) return false;
  const std::uint32_t frame = target();
  if (frame == 0) return track.standsAt(track.report().frame);
  const FrameRecord* record = track.report().record(frame);
  const bool judges = current_.check && track.spec().test_case.algorithm.traits.finds_pairs;
  if (record == nullptr || (judges && !record->checked)) return false;
  if (&track == shownTrack()) return isAnswerCached(frame) && !current_.structure;
  // Of another one the second view wants the answer itself.
  return !current_.second || current_.second->track != track.spec().number;
}

/// Shows a frame that has been seen before any algorithm is run. Returns whether it did.
bool RunThread::showCached() {
  const std::uint32_t frame = target();
  const AlgorithmTrack* track = shownTrack();
  const bool stands = track != nullptr && track->standsAt(frame);
  const bool there = shown_ && progress_.snapshot->frame == frame;
  if (current_.playing || current_.second || stands || there || !isAnswerCached(frame))
    return false;
  show();
  return true;
}

}  // namespace broadmark
