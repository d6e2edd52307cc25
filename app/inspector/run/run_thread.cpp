#include "inspector/run/run_thread.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "support/granted_thread.h"
#include "support/words.h"

namespace broadmark {
namespace {

/// Limits the pairs to 512 MiB, in case all bodies overlap by mistake.
constexpr std::size_t kMaxPairs = std::size_t{1} << 26;

/// Whether both requests need the same snapshot content, apart from source and frame.
bool sameSnapshot(const ViewRequest& a, const ViewRequest& b) {
  return a.check == b.check && a.shown_track == b.shown_track && a.structure == b.structure &&
         a.trail_bodies == b.trail_bodies && a.second == b.second;
}

/// Whether both show the same scene, maybe another version of it.
bool isVersionOf(const FrameProviderRequest* a, const FrameProviderRequest* b) {
  return a == b || (a != nullptr && b != nullptr && a->scene != 0 && a->scene == b->scene);
}

/// Number of overlapping pairs, computed from an algorithm's answer and its mismatches.
std::uint64_t overlappingPairs(const FrameRecord& record) {
  const FrameCounts& counts = record.counts;
  return counts[FrameCount::pairs] + counts[FrameCount::missed] - counts[FrameCount::false_pairs] -
         counts[FrameCount::allowed_extra] - counts[FrameCount::invalid];
}

float fractionOf(std::uint32_t part, std::uint32_t whole) {
  return whole == 0 ? 1.0F : static_cast<float>(part) / static_cast<float>(whole);
}

}  // namespace

RunThread::RunThread(ExecutorFactory make_executor, SimulationHost host)
    : make_executor_(std::move(make_executor)),
      host_(std::move(host)),
      oracle_(makeOracle()),
      second_oracle_(makeOracle()),
      thread_(grantedThread([this] { loop(); })) {}

Oracle RunThread::makeOracle() {
  return Oracle(std::size_t{256} << 20, kMaxPairs, [this] { return isSourceCancelled(); });
}

RunThread::~RunThread() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void RunThread::request(ViewRequest request) {
  {
    const std::lock_guard lock(mutex_);
    requested_ = std::move(request);
    ++posted_;
  }
  changed_.notify_all();
}

void RunThread::readProgress(const std::function<void(const RunProgress&)>& visitor) {
  const std::lock_guard lock(mutex_);
  if (isVersionOf(requested_.source.get(), progress_.source.get())) {
    visitor(progress_);
  } else {
    visitor({.activity = progress_.activity, .fraction = progress_.fraction});
  }
}

bool RunThread::isIdle() {
  const std::lock_guard lock(mutex_);
  return isDone();
}

bool RunThread::waitUntilIdle(std::chrono::milliseconds timeout) {
  if (!thread_.joinable()) {
    proceed(timeout);
    return isIdle();
  }
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, timeout, [this] { return isDone(); });
}

void RunThread::proceed(std::chrono::milliseconds budget) {
  if (thread_.joinable()) return;
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  while (!isDone()) {
    work(lock);
    if (std::chrono::steady_clock::now() - start >= budget) return;
  }
}

void RunThread::loop() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (isDone()) {
      changed_.wait(lock, [this] { return stopping_ || !isDone(); });
    } else {
      work(lock);
    }
  }
}

/// Executes a step of the latest request, which is not done. Requires mutex_, and returns with it.
void RunThread::work(std::unique_lock<std::mutex>& lock) {
  if (applied_ != posted_) applyRequest();
  lock.unlock();
  bool more = false;
  try {
    more = step();
  } catch (const Cancelled&) {
    more = true;  // by a new request
  } catch (const std::exception& error) {
    publishFailure(error.what());
  }
  lock.lock();
  if (more || applied_ != posted_) return;
  idle_ = true;
  progress_.activity.clear();
  changed_.notify_all();
}

/// Requires mutex_.
void RunThread::applyRequest() {
  if (!sameSnapshot(current_, requested_)) snapshots_valid_ = false;
  cache_tried_ = false;
  // A track beyond the target may continue only if its frames after the target were checked.
  if (requested_.check && provider_) {
    for (const auto& track : tracks_) track->restartUnlessChecked(target());
  }
  current_ = requested_;
  applied_ = posted_;
  idle_ = false;
}

/// Runs the next unit of work; returns false if none is left.
bool RunThread::step() {
  if (current_.source != open_source_) {
    openSource();
    return true;
  }
  if (provider_ == nullptr) return false;
  if (updateTracks()) return true;
  if (!std::exchange(cache_tried_, true) && publishCachedSnapshot()) return true;
  if (advance() || advanceSecond()) return true;
  if (snapshots_valid_) return false;
  publishSnapshots();
  return true;
}

void RunThread::publishFailure(std::string reason) {
  const std::lock_guard lock(mutex_);
  progress_.failure = std::move(reason);
}

bool RunThread::isSourceCancelled() {
  const std::lock_guard lock(mutex_);
  return stopping_ || requested_.source != open_source_;
}

bool RunThread::isSecondSourceCancelled() {
  if (isSourceCancelled()) return true;
  const std::lock_guard lock(mutex_);
  return !requested_.second || requested_.second->source != second_.opened;
}

bool RunThread::isTrackCancelled(const TrackSpec& spec) {
  const std::lock_guard lock(mutex_);
  return stopping_ || requested_.source != open_source_ ||
         std::ranges::find(requested_.tracks, spec) == requested_.tracks.end();
}

bool RunThread::isSecondTrackCancelled(const TrackSpec& spec) {
  if (isTrackCancelled(spec)) return true;
  const std::lock_guard lock(mutex_);
  return !requested_.second || requested_.second->track != spec.number ||
         requested_.second->source != current_.second->source;
}

void RunThread::publishActivity(std::string activity, float fraction) {
  const std::lock_guard lock(mutex_);
  progress_.activity = std::move(activity);
  progress_.fraction = fraction;
}

void RunThread::openSource() {
  publishActivity(current_.source ? fmt::format("opening {}", current_.source->title) : "", 0);
  tracks_.clear();
  second_ = {};
  provider_.reset();
  oracle_ = makeOracle();
  cache_.clear();
  stop_.reset();
  snapshots_valid_ = false;
  open_source_ = current_.source;
  std::string failure;
  try {
    if (open_source_) {
      provider_ = open_source_->open(host_, [this] { return isSourceCancelled(); });
    }
  } catch (const Cancelled&) {
    open_source_.reset();  // it is opened again if it is requested again
    throw;
  } catch (const std::exception& error) {
    failure = error.what();
  }
  const std::lock_guard lock(mutex_);
  progress_ = RunProgress{.source = open_source_, .failure = std::move(failure)};
  if (provider_ == nullptr) return;
  progress_.scene = provider_->scene();
  progress_.available_frames = provider_->lastAvailable();
  progress_.live = provider_->live();
  progress_.frames = provider_->opener();
}

void RunThread::openSecondSource() {
  const auto& source = current_.second->source;
  publishActivity(fmt::format("opening {}", source ? source->title : ""), 1);
  snapshots_valid_ = false;
  second_ = {.opened = source};
  try {
    if (source) {
      second_.provider = source->open(host_, [this] { return isSecondSourceCancelled(); });
    }
  } catch (const Cancelled&) {
    second_ = {};
    throw;
  } catch (const std::exception& error) {
    second_.failure = error.what();
  }
}

void RunThread::simulateNext(FrameProvider& provider) {
  const std::uint32_t next = provider.lastAvailable() + 1;
  const bool second = &provider != provider_.get();
  publishActivity(fmt::format("simulating frame {} of {}{}", next,
                              counted(provider.scene().objects, "body", "bodies"),
                              second ? " for the second view" : ""),
                  second ? 1 : fractionOf(next - 1, std::max(target(), next)));
  try {
    provider.simulateNext();
  } catch (const Cancelled&) {  // opened again if it is requested again
    if (second) {
      second_ = {};
    } else {
      open_source_.reset();
    }
    throw;
  }
}

/// Adds and removes tracks to match the request. Returns whether any changed.
bool RunThread::updateTracks() {
  const auto spec_of = [](const auto& track) -> const TrackSpec& { return track->spec(); };
  if (std::ranges::equal(tracks_, current_.tracks, {}, spec_of)) return false;

  std::vector<std::unique_ptr<AlgorithmTrack>> old_tracks = std::move(tracks_);
  tracks_.clear();
  for (const TrackSpec& spec : current_.tracks) {
    const auto found = std::ranges::find_if(
        old_tracks, [&](const auto& track) { return track && track->spec() == spec; });
    tracks_.push_back(found != old_tracks.end()
                          ? std::move(*found)
                          : std::make_unique<AlgorithmTrack>(spec, make_executor_, [this, spec] {
                              return isTrackCancelled(spec);
                            }));
  }
  for (const auto& removed : old_tracks) {
    if (removed) cache_.erase(removed->spec().number);
  }
  old_tracks.clear();
  snapshots_valid_ = false;
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

/// Reads a frame and records its population.
Frame RunThread::frameAt(std::uint32_t index) {
  const Frame frame = provider_->at(index);
  recordPopulation(index, frame.boxes);
  return frame;
}

void RunThread::recordPopulation(std::uint32_t index, std::span<const Aabb> boxes) {
  if (provider_->scene().all_present) return;
  const auto present = static_cast<float>(countPresent(boxes));
  const std::lock_guard lock(mutex_);
  progress_.population.set(index, present);
}

/// Advances the source or one track by a frame towards the target. Returns false at the target.
bool RunThread::advance() {
  if (stop_ && (!current_.check || !current_.stop_at_mismatch ||
                (current_.acknowledged && *current_.acknowledged >= stop_->frame))) {
    stop_.reset();
    const std::lock_guard lock(mutex_);
    progress_.stop.reset();
  }
  const bool shared = current_.second && !current_.second->source;
  const std::uint32_t second_frame = shared ? current_.second->frame.value_or(0) : 0;
  const std::uint32_t needed =
      std::max(target(), std::min(second_frame, provider_->scene().frames));
  if (provider_->lastAvailable() < needed) {
    simulateNext(*provider_);
    if (!provider_->scene().all_present) frameAt(provider_->lastAvailable());
    const std::lock_guard lock(mutex_);
    progress_.available_frames = provider_->lastAvailable();
    return true;
  }
  // Advance the trailing track, so that the tracks stay within a frame of each other.
  AlgorithmTrack* trailing = nullptr;
  for (const auto& track : tracks_) {
    if (track->report().finished || track->isAt(target()) || isServedFromCache(*track)) continue;
    const bool restarts = track->report().frame > target() || !track->isAt(track->report().frame);
    if (restarts) {
      track->restart(provider_->scene(), provider_->at(0));
      publishTrack(*track);
      snapshots_valid_ = false;
      return true;
    }
    if (trailing == nullptr || track->report().frame < trailing->report().frame) {
      trailing = track.get();
    }
  }
  if (trailing == nullptr) {
    const std::lock_guard lock(mutex_);
    if (!progress_.snapshot || progress_.snapshot->source != open_source_ ||
        progress_.snapshot->frame != target()) {
      snapshots_valid_ = false;
    }
    return false;
  }
  const std::uint32_t next = trailing->report().frame + 1;
  const std::string& id = trailing->spec().test_case.algorithm.id;
  publishActivity(trailing->report().record(next) != nullptr
                      ? fmt::format("running {} again up to frame {}", id, target())
                      : fmt::format("{}: frame {}", id, next),
                  fractionOf(next, target()));
  return advanceTrack(*trailing, frameAt(next));
}

bool RunThread::advanceTrack(AlgorithmTrack& track, const Frame& frame) {
  snapshots_valid_ = false;
  track.advance(frame, draw_gate_);
  std::optional<FrameDifference> difference;
  if (current_.check && track.isAt(frame.index)) {
    difference = track.check(frame, oracle_);
    const bool acknowledged = current_.acknowledged && frame.index <= *current_.acknowledged;
    if (difference && difference->isMismatch() && !acknowledged && current_.stop_at_mismatch &&
        (!stop_ || frame.index < stop_->frame)) {
      stop_ = RunProgress::Stop{.frame = frame.index, .track = track.spec().number};
      const std::lock_guard lock(mutex_);
      progress_.stop = stop_;
    }
  }
  // At the target publishSnapshots() caches the answer.
  if (&track == shownTrack() && frame.index != target() && track.isAt(frame.index) &&
      !isAnswerCached(frame.index)) {
    const CachedAnswer answer =
        answerOf(track, frame, current_.check, std::move(difference), provider_->scene(), oracle_);
    if (track.isAt(frame.index)) cache_.insert(track.spec().number, frame.index, answer);
  }
  publishTrack(track);
  return true;
}

void RunThread::publishTrack(const AlgorithmTrack& track) {
  const TrackReport& now = track.report();
  const std::lock_guard lock(mutex_);
  const auto published =
      std::ranges::find(progress_.tracks, now.spec.number,
                        [](const TrackReport& report) { return report.spec.number; });
  if (published == progress_.tracks.end()) return;
  static_cast<TrackState&>(*published) = now;
  // Copy only the current record: the rest of the history is unchanged, and long.
  published->frames.resize(now.frames.size());
  if (now.frame == 0) return;
  const FrameRecord& record = now.frames[now.frame - 1];
  published->frames[now.frame - 1] = record;
  published->curves.set(now.frame, record);
  if (now.spec.test_case.answer == AnswerKind::pairs &&
      now.spec.test_case.algorithm.traits.finds_pairs) {
    progress_.pairs.set(now.frame, static_cast<float>(overlappingPairs(record)));
  }
}

AlgorithmTrack* RunThread::findTrack(int number) const {
  const auto found =
      std::ranges::find(tracks_, number, [](const auto& track) { return track->spec().number; });
  return found == tracks_.end() ? nullptr : found->get();
}

AlgorithmTrack* RunThread::shownTrack() const {
  return target() > 0 ? findTrack(current_.shown_track) : nullptr;
}

FrameProvider* RunThread::secondProvider() const {
  return second_.opened ? second_.provider.get() : provider_.get();
}

std::uint32_t RunThread::secondTarget() const {
  return std::min(current_.second->frame.value_or(target()), secondProvider()->scene().frames);
}

AlgorithmTrack* RunThread::secondTrack() {
  AlgorithmTrack* const first_view_track = findTrack(current_.second->track);
  if (first_view_track == nullptr) {
    second_.track.reset();
    return nullptr;
  }
  if (secondTarget() == 0) return nullptr;  // frame 0 has no answer
  if (!second_.opened && secondTarget() == target()) return first_view_track;
  if (const TrackSpec& spec = first_view_track->spec();
      !second_.track || second_.track->spec() != spec) {
    second_.track = std::make_unique<AlgorithmTrack>(
        spec, make_executor_, [this, spec] { return isSecondTrackCancelled(spec); });
  }
  return second_.track.get();
}

/// Advances the second view by one step. Returns false if it is up to date.
bool RunThread::advanceSecond() {
  if (!current_.second) return false;
  if (current_.second->source != second_.opened) {
    openSecondSource();
    return true;
  }
  FrameProvider* const provider = secondProvider();
  if (provider == nullptr) return false;
  if (provider->lastAvailable() < secondTarget()) {
    simulateNext(*provider);
    snapshots_valid_ = false;
    return true;
  }
  AlgorithmTrack* const track = secondTrack();
  if (track == nullptr || track != second_.track.get()) return false;  // advance() runs it
  const std::uint32_t frame = track->report().frame;
  if (track->report().finished || track->isAt(secondTarget())) return false;
  publishActivity(fmt::format("{} for the second view: frame {}",
                              track->spec().test_case.algorithm.id, frame + 1),
                  1);
  snapshots_valid_ = false;
  if (frame > secondTarget() || !track->isAt(frame)) {
    track->restart(provider->scene(), provider->at(0));
  } else {
    track->advance(provider->at(frame + 1), draw_gate_);
  }
  return true;
}

std::shared_ptr<const Snapshot> RunThread::captureSecondSnapshot() {
  return captureSnapshot({.source = second_.opened ? second_.opened : open_source_,
                          .provider = *secondProvider(),
                          .frame = secondTarget(),
                          .track = secondTrack(),
                          .check = current_.check,
                          .structure = current_.structure,
                          .trail_bodies = current_.trail_bodies},
                         second_oracle_);
}

void RunThread::publishSnapshots() {
  const std::uint32_t index = target();
  const auto snapshot = captureSnapshot({.source = open_source_,
                                         .provider = *provider_,
                                         .frame = index,
                                         .track = shownTrack(),
                                         .cache = &cache_,
                                         .check = current_.check,
                                         .structure = current_.structure,
                                         .trail_bodies = current_.trail_bodies},
                                        oracle_);
  if (!current_.second) second_ = {};
  const bool has_second = current_.second && secondProvider() != nullptr;
  const auto second = snapshot && has_second ? captureSecondSnapshot() : nullptr;
  if (!snapshot || (has_second && !second)) {  // a track has failed: retry without it
    for (const auto& track : tracks_) publishTrack(*track);
    return;
  }
  if (index > 0) recordPopulation(index - 1, *snapshot->boxes_before);
  recordPopulation(index, *snapshot->boxes);
  std::shared_ptr<const PairComparison> comparison;
  if (second) {
    comparison =
        std::make_shared<const PairComparison>(comparePairs(snapshot->pairs, second->pairs));
  }
  snapshots_valid_ = true;
  const std::lock_guard lock(mutex_);
  if (snapshot->track == 0) progress_.pairs.set(index, static_cast<float>(snapshot->pairs.size()));
  progress_.snapshot = snapshot;
  progress_.second = second;
  progress_.comparison = std::move(comparison);
  progress_.second_failure = second_.failure;
}

bool RunThread::isAnswerCached(std::uint32_t frame) const {
  if (const AlgorithmTrack* track = shownTrack()) {
    return cache_.contains(track->spec().number, frame, current_.check);
  }
  return cache_.contains(0, frame, false);
}

bool RunThread::isServedFromCache(const AlgorithmTrack& track) const {
  if (current_.playing) return false;
  const std::uint32_t frame = target();
  if (frame == 0) return track.isAt(track.report().frame);
  const FrameRecord* record = track.report().record(frame);
  const bool checks = current_.check && track.spec().test_case.algorithm.traits.finds_pairs;
  if (record == nullptr || (checks && !record->checked)) return false;
  if (&track == shownTrack()) return isAnswerCached(frame) && !current_.structure;
  // The second view needs the answer of its track, not only the record.
  return !current_.second || current_.second->track != track.spec().number;
}

/// Shows a cached frame at once, before any algorithm runs. Returns whether it did.
bool RunThread::publishCachedSnapshot() {
  const std::uint32_t frame = target();
  const AlgorithmTrack* track = shownTrack();
  const bool at_frame = track != nullptr && track->isAt(frame);
  const bool shown = snapshots_valid_ && progress_.snapshot->frame == frame;
  if (current_.playing || current_.second || at_frame || shown || !isAnswerCached(frame))
    return false;
  publishSnapshots();
  return true;
}

}  // namespace broadmark
