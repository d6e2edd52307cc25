#include "inspector/run/algorithm_track.h"

#include <algorithm>
#include <span>

#include "broadmark/harness/runner.h"

namespace broadmark {
namespace {

constexpr RunPolicy kPolicy{.check = CheckMode::hash,
                            .frame_limit_seconds = AlgorithmTrack::kFrameLimitSeconds};

}  // namespace

void LaneCurves::set(std::uint32_t frame, const FrameRecord& record) {
  for (std::size_t phase = 0; phase < seconds.size(); ++phase) {
    seconds[phase].set(frame,
                       static_cast<float>(1e-9 * static_cast<double>(record.times.values[phase])));
  }
  pairs.set(frame, static_cast<float>(record.counts[FrameCount::pairs]));
  disturbed.set(frame, record.disturbed ? 1 : FrameValues::kUnknown);
  mismatches.set(frame, record.mismatch ? 1 : FrameValues::kUnknown);
}

const LaneReport* laneOf(const std::vector<LaneReport>& lanes, int number) {
  const auto found =
      std::ranges::find(lanes, number, [](const LaneReport& lane) { return lane.spec.number; });
  return found == lanes.end() ? nullptr : &*found;
}

std::uint64_t framesOver(const LaneReport& lane, double ms) {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(lane.frames, [&](const FrameRecord& frame) {
        return frame.run && static_cast<double>(frame.times[Phase::total]) > ms * 1e6;
      }));
}

template <class Call>
void AlgorithmTrack::attempt(Call&& call) {
  try {
    call();
    report_.status = run_->status();
    report_.reason = run_->reason();
    report_.ended = !run_->running();
  } catch (const std::exception& error) {
    report_.status = Status::error;
    report_.reason = error.what();
    report_.ended = true;
  }
}

void AlgorithmTrack::restart(const SceneInfo& scene, const Frame& first) {
  report_.frame = 0;
  outdated_ = false;
  attempt([&] {
    if (!run_) run_.emplace(spec().run, kPolicy, make_host_, cancelled_);
    if (run_->start(scene, first)) report_.setup = run_->setup();
  });
  if (report_.ended) return;
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
  attempt([&] { run_->step(frame); });
  record.disturbed = gate.endTiming();
  if (!run_->answered()) return;
  record.run = true;
  record.frame = frame.index;
  record.times = run_->times();
  record.counts[FrameCount::pairs] = run_->pairs();
  recordOf(frame.index) = record;
  report_.curves.set(frame.index, record);
  report_.frame = frame.index;
  attempt([&] { report_.counters = run_->counters(); });
}

std::optional<FrameDifference> AlgorithmTrack::check(const Frame& frame, Oracle& oracle) {
  std::optional<FrameDifference> difference;
  attempt([&] { difference = run_->check(frame, oracle); });
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

void AlgorithmTrack::requireChecked(std::uint32_t after) {
  if (!spec().run.algorithm.traits.finds_pairs || after >= report_.frame) return;
  outdated_ = !std::ranges::all_of(std::span(report_.frames).subspan(after, report_.frame - after),
                                   &FrameRecord::checked);
}

std::vector<Pair> AlgorithmTrack::answer() {
  std::vector<Pair> pairs;
  attempt([&] {
    const PairRuns runs = run_->answer();
    pairs.reserve(pairCount(runs));
    for (const PairRun run : runs) pairs.insert(pairs.end(), run.begin(), run.end());
  });
  return pairs;
}

RecordedDrawing AlgorithmTrack::structure() {
  RecordedDrawing drawing;
  attempt([&] { drawing = run_->structure(); });
  return drawing;
}

std::string formatFrameTable(const SceneInfo& scene, const std::vector<LaneReport>& lanes) {
  FrameTable table;
  for (const LaneReport& lane : lanes) {
    table.begin(beginCase(lane.spec.run, {.scene = scene}));
    for (const FrameRecord& record : lane.frames) {
      if (record.run) table.add(record);
    }
  }
  return table.text();
}

}  // namespace broadmark
