// Repetitions of cases, and their results.

#include "broadmark/harness/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace broadmark {
namespace {

/// Collects the counts of one pass's frames.
class FrameCounter {
 public:
  /// `result` outlives this.
  explicit FrameCounter(CaseResult& result)
      : result_(result),
        is_first_pass_(result.repetitions.empty()),
        repetition_(static_cast<int>(result.repetitions.size()) + 1) {}

  /// Counts the last frame run; each call advances to the next frame.
  void count(const Frame& frame, CaseRun& case_run, Oracle& oracle) {
    if (frames_done_ == result_.frames.size()) result_.frames.emplace_back();
    FrameCounts& counts = result_.frames[frames_done_++];
    auto difference = case_run.check(frame, oracle);
    if (difference) mergeMaxima(counts, *difference);
    if (is_first_pass_ && case_run.answered()) {
      countWork(counts, case_run);
      countBodies(frame);
    }
    if (!difference || !difference->isMismatch()) return;
    difference->repetition = repetition_;
    result_.differences.push_back(std::move(*difference));
  }

 private:
  /// Stores the maxima over the passes: repeated wrong pairs are counted once.
  void mergeMaxima(FrameCounts& counts, const FrameDifference& difference) {
    const auto merge = [&](FrameCount which, std::uint64_t found, std::uint64_t& sum) {
      const std::uint64_t more = found - std::min(found, counts[which]);
      counts[which] += more;
      sum += more;
    };
    merge(FrameCount::missed, difference.missed_count, result_.missed_count);
    merge(FrameCount::false_pairs, difference.false_count, result_.false_count);
    merge(FrameCount::allowed_extra, difference.allowed_extra_count, result_.allowed_extra_count);
    merge(FrameCount::invalid, difference.invalid_count, result_.invalid_count);
  }

  /// Counts pairs and work, in the first pass only: the others repeat them.
  void countWork(FrameCounts& counts, CaseRun& case_run) {
    counts[FrameCount::pairs] = case_run.pairs();
    counts[FrameCount::changed_bodies] = case_run.changedBodies();
    const std::size_t before = frames_done_ - 1;
    addToMean(result_.pairs_mean, case_run.pairs(), before);
    result_.pairs_max = std::max(result_.pairs_max, case_run.pairs());
    const Counts counters = case_run.counters();
    for (const auto& [name, count] : counters) addToMean(result_.counters[name], count, before);
    addToAgeing(counters, case_run.report().private_bytes, before);
  }

  void addToAgeing(const Counts& counters, std::optional<std::uint64_t> private_bytes,
                   std::size_t frame) {
    constexpr std::size_t kMinFrames = 100;
    const std::size_t frames = result_.recording.scene.frames;
    const std::size_t tenth = frames / 10;
    if (frames < kMinFrames || (frame >= tenth && frame < frames - tenth)) return;
    Ageing& ageing = result_.ageing ? *result_.ageing : result_.ageing.emplace();
    std::map<std::string, double>& means = frame < tenth ? ageing.early : ageing.late;
    const std::size_t before = frame < tenth ? frame : frame - (frames - tenth);
    for (const auto& [name, count] : counters) addToMean(means[name], count, before);
    if (private_bytes) addToMean(means["private_bytes"], *private_bytes, before);
  }

  void countBodies(const Frame& frame) {
    if (result_.recording.scene.all_present) return;
    const auto present =
        static_cast<std::uint64_t>(std::ranges::count_if(frame.boxes, std::not_fn(isEmpty)));
    Population& bodies = result_.bodies ? *result_.bodies : result_.bodies.emplace();
    addToMean(bodies.mean, present, frames_done_ - 1);
    bodies.max = std::max(bodies.max, present);
  }

  /// Adds a value to the mean of `count_before` values.
  static void addToMean(double& mean, std::uint64_t value, std::uint64_t count_before) {
    mean += (static_cast<double>(value) - mean) / static_cast<double>(count_before + 1);
  }

  CaseResult& result_;
  bool is_first_pass_;
  int repetition_;
  std::size_t frames_done_ = 0;
};

}  // namespace

std::string recordingId(const RecordingReference& recording) {
  const SceneInfo& scene = recording.scene;
  std::string id =
      fmt::format("{}/{}/N{}/F{}", scene.name, scene.object_type, scene.objects, scene.frames);
  if (recording.seed) id += fmt::format("/s{}", *recording.seed);
  for (const auto& [name, value] : recording.swept) {
    if (name != "seed") id += fmt::format("/{}={}", name, value);
  }
  for (const auto& [name, value] : recording.reading) {
    // Names already contain "swept" and "elements".
    if (name != "swept" && name != "elements") id += fmt::format("/{}={}", name, value);
  }
  return id;
}

std::string caseId(const RecordingReference& recording, const Case& test_case) {
  return recordingId(recording) + '/' + caseName(test_case);
}

std::string caseNameOf(const CaseResult& result) {
  const std::string recording = recordingId(result.recording) + '/';
  return result.id.starts_with(recording) ? result.id.substr(recording.size()) : result.id;
}

std::string variantOf(const CaseResult& result) {
  std::string text = caseNameOf(result) + '/';
  for (const std::string& part :
       {fmt::format("/{}/", isaName(result.isa)), fmt::format("/t{}/", result.threads)}) {
    const std::size_t position = text.find(part);
    if (position != text.npos) text.erase(position, part.size() - 1);
  }
  text.pop_back();
  return text;
}

CaseResult beginCase(const Case& test_case, const RecordingReference& recording) {
  CaseResult result;
  result.id = caseId(recording, test_case);
  result.recording = recording;
  result.algorithm = test_case.algorithm.id;
  result.family = test_case.algorithm.family;
  result.isa = test_case.isa;
  result.vectorised = test_case.algorithm.traits.vectorised;
  result.threads = test_case.threads;
  result.device = test_case.device;
  result.plugin = test_case.algorithm.plugin;
  result.parameters = parameterValues(*makeInstance(test_case));
  result.answer = test_case.answer;
  return result;
}

bool runRepetition(CaseResult& result, CaseRun& case_run, FrameSource& source, Oracle& oracle,
                   const RunHooks& hooks, bool measured) {
  result.checked = case_run.checks();
  result.conditions.counted_by = case_run.countedBy();
  Repetition repetition;
  repetition.frames.reserve(source.scene().frames);
  try {
    const Frame first = source.rewind();
    FrameCounter counter(result);
    if (case_run.start(source.scene(), first) && result.setup.empty()) {
      result.setup = case_run.setup();
    }
    if (!case_run.countedBy()) repetition.initialize_ns = case_run.initializeNanoseconds();
    while (case_run.running()) {
      const std::optional<Frame> frame = source.next();
      if (!frame) break;
      if (hooks.cancelled && hooks.cancelled()) {
        case_run.stop();
        return false;
      }
      case_run.step(*frame);
      if (!case_run.answered()) break;
      if (!case_run.countedBy()) repetition.frames.push_back(case_run.times());
      counter.count(*frame, case_run, oracle);
      if (hooks.progress) hooks.progress(frame->index);
    }
    const bool instance_survived = case_run.hasInstance();
    case_run.stop();
    repetition.processor = case_run.report().processor;
    if (measured && instance_survived) result.repetitions.push_back(std::move(repetition));
  } catch (const Cancelled&) {
    return false;
  }
  result.status = case_run.status();
  result.reason = case_run.reason();
  if (!result.timed() && result.status == Status::ok && measured &&
      !result.repetitions.back().processor[ProcessorCounter::instructions]) {
    result.status = Status::error;
    result.reason = "no instructions were counted";
  }
  result.peak_bytes = std::max(result.peak_bytes, case_run.report().peak_bytes);
  result.conditions.pinned = case_run.report().pinned;
  return true;
}

CaseResult runCase(const Case& test_case, FrameSource& source, const RunPolicy& policy,
                   int repetitions) {
  CaseResult result = beginCase(test_case, {.scene = source.scene()});
  CaseRun case_run(test_case, policy);
  Oracle oracle;
  for (int repetition = 0; repetition < repetitions && result.status == Status::ok; ++repetition) {
    runRepetition(result, case_run, source, oracle);
  }
  return result;
}

}  // namespace broadmark
