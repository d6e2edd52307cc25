#include "inspector/run/algorithm_track.h"

#include <algorithm>
#include <span>

#include "broadmark/harness/runner.h"

namespace broadmark {
namespace {

constexpr RunPolicy kPolicy{.check = CheckMode::hash,
                            .frame_limit_seconds = AlgorithmTrack::kFrameLimitSeconds};

}  // namespace

void TrackCurves::set(std::uint32_t frame, const FrameRecord& record) {
  for (std::size_t phase = 0; phase < seconds.size(); ++phase) {
    seconds[phase].set(frame,
                       static_cast<float>(1e-9 * static_cast<double>(record.times.values[phase])));
  }
  pairs.set(frame, static_cast<float>(record.counts[FrameCount::pairs]));
  disturbed.set(frame, record.disturbed ? 1 : FrameValues::kUnknown);
  mismatches.set(frame, record.mismatch ? 1 : FrameValues::kUnknown);
}

const TrackReport* findTrack(const std::vector<TrackReport>& tracks, int number) {
  const auto found =
      std::ranges::find(tracks, number, [](const TrackReport& track) { return track.spec.number; });
  return found == tracks.end() ? nullptr : &*found;
}

std::uint64_t framesOver(const TrackReport& track, double ms) {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(track.frames, [&](const FrameRecord& frame) {
        return frame.run && static_cast<double>(frame.times[Phase::total]) > ms * 1e6;
      }));
}

template <class Call>
void AlgorithmTrack::callGuarded(Call&& call) {
  try {
    call();
    report_.status = run_->status();
    report_.reason = run_->reason();
    report_.finished = !run_->running();
  } catch (const std::exception& error) {
    report_.status = Status::error;
    report_.reason = error.what();
    report_.finished = true;
  }
}

void AlgorithmTrack::restart(const SceneInfo& scene, const Frame& first) {
  report_.frame = 0;
  stale_ = false;
  callGuarded([&] {
    if (!run_) run_.emplace(spec().test_case, kPolicy, make_executor_, cancelled_);
    if (run_->start(scene, first)) report_.setup = run_->setup();
  });
  if (report_.finished) return;
  report_.margin = run_->margin();
  report_.initialize_ns = run_->initializeNanoseconds();
}

FrameRecord& AlgorithmTrack::recordOf(std::uint32_t index) {
  if (report_.frames.size() < index) report_.frames.resize(index);
  return report_.frames[index - 1];
}

void AlgorithmTrack::advance(const Frame& frame, DrawGate& gate) {
  FrameRecord record;
  gate.beginTiming();
  callGuarded([&] { run_->step(frame); });
  record.disturbed = gate.endTiming();
  if (!run_->answered()) return;
  record.run = true;
  record.frame = frame.index;
  record.times = run_->times();
  record.counts[FrameCount::pairs] = run_->pairs();
  recordOf(frame.index) = record;
  report_.curves.set(frame.index, record);
  report_.frame = frame.index;
  callGuarded([&] { report_.counters = run_->counters(); });
}

std::optional<FrameDifference> AlgorithmTrack::check(const Frame& frame, Oracle& oracle) {
  std::optional<FrameDifference> difference;
  callGuarded([&] { difference = run_->check(frame, oracle); });
  if (!difference) return difference;
  FrameRecord& record = recordOf(frame.index);
  record.checked = true;
  record.counts[FrameCount::missed] = difference->missed_count;
  record.counts[FrameCount::false_pairs] = difference->false_count;
  record.counts[FrameCount::allowed_extra] = difference->allowed_extra_count;
  record.counts[FrameCount::invalid] = difference->invalid_count;
  record.mismatch = difference->isMismatch();
  report_.curves.set(frame.index, record);
  return difference;
}

void AlgorithmTrack::restartUnlessChecked(std::uint32_t after) {
  if (!spec().test_case.algorithm.traits.finds_pairs || after >= report_.frame) return;
  stale_ = !std::ranges::all_of(std::span(report_.frames).subspan(after, report_.frame - after),
                                &FrameRecord::checked);
}

std::vector<Pair> AlgorithmTrack::answer() {
  std::vector<Pair> pairs;
  callGuarded([&] {
    const PairRuns answer = run_->answer();
    pairs.reserve(pairCount(answer));
    for (const PairRun chunk : answer) pairs.insert(pairs.end(), chunk.begin(), chunk.end());
  });
  return pairs;
}

RecordedDrawing AlgorithmTrack::structure() {
  RecordedDrawing drawing;
  callGuarded([&] { drawing = run_->structure(); });
  return drawing;
}

std::string formatFrameTable(const SceneInfo& scene, const std::vector<TrackReport>& tracks) {
  FrameTable table;
  for (const TrackReport& track : tracks) {
    table.begin(beginCase(track.spec.test_case, {.scene = scene}));
    for (const FrameRecord& record : track.frames) {
      if (record.run) table.add(record);
    }
  }
  return table.text();
}

}  // namespace broadmark
