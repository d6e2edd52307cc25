// Repetitions of cases, and what is kept of them.

#include "broadmark/harness/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace broadmark {
namespace {

/// Counts what happens in the frames of one pass.
class FrameCounter {
 public:
  /// `result` outlives this.
  explicit FrameCounter(CaseResult& result)
      : result_(result),
        is_first_pass_(result.repetitions.empty()),
        number_(static_cast<int>(result.repetitions.size()) + 1) {}

  /// The frame that was run last; the next one counts as another.
  void count(const Frame& frame, CaseRun& run, Oracle& oracle) {
    if (passed_ == result_.frames.size()) result_.frames.emplace_back();
    FrameCounts& counts = result_.frames[passed_++];
    auto difference = run.check(frame, oracle);
    if (difference) keepWorst(counts, *difference);
    if (is_first_pass_ && run.answered()) {
      countWork(counts, run);
      countBodies(frame);
    }
    if (!difference || !difference->isMismatch()) return;
    difference->repetition = number_;
    result_.differences.push_back(std::move(*difference));
  }

 private:
  /// Wrong pairs are counted once, however many passes show them.
  void keepWorst(FrameCounts& counts, const FrameDifference& difference) {
    const auto keep = [&](FrameCount which, std::uint64_t found, std::uint64_t& sum) {
      const std::uint64_t more = found - std::min(found, counts[which]);
      counts[which] += more;
      sum += more;
    };
    keep(FrameCount::missed, difference.missed_count, result_.missed_count);
    keep(FrameCount::false_pairs, difference.false_count, result_.false_count);
    keep(FrameCount::allowed_extra, difference.allowed_extra_count, result_.allowed_extra_count);
    keep(FrameCount::invalid, difference.invalid_count, result_.invalid_count);
  }

  /// Counts of pairs and of work, in the first pass: the others do the same.
  void countWork(FrameCounts& counts, CaseRun& run) {
    counts[FrameCount::pairs] = run.pairs();
    counts[FrameCount::changed_bodies] = run.changedBodies();
    const std::size_t before = passed_ - 1;
    addToMean(result_.pairs_mean, run.pairs(), before);
    result_.pairs_max = std::max(result_.pairs_max, run.pairs());
    for (const auto& [name, count] : run.counters()) {
      addToMean(result_.counters[name], count, before);
    }
  }

  void countBodies(const Frame& frame) {
    if (result_.recording.scene.all_present) return;
    const auto present =
        static_cast<std::uint64_t>(std::ranges::count_if(frame.boxes, std::not_fn(isEmpty)));
    Population& bodies = result_.bodies ? *result_.bodies : result_.bodies.emplace();
    addToMean(bodies.mean, present, passed_ - 1);
    bodies.max = std::max(bodies.max, present);
  }

  /// Takes one more value into the mean of `count_before`.
  static void addToMean(double& mean, std::uint64_t value, std::uint64_t count_before) {
    mean += (static_cast<double>(value) - mean) / static_cast<double>(count_before + 1);
  }

  CaseResult& result_;
  bool is_first_pass_;
  int number_;
  std::size_t passed_ = 0;  ///< frames
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
    // Of swept boxes and of elements, names tell.
    if (name != "swept" && name != "elements") id += fmt::format("/{}={}", name, value);
  }
  return id;
}

std::string caseId(const RecordingReference& recording, const Case& run) {
  return recordingId(recording) + '/' + caseName(run);
}

std::string caseNameOf(const CaseResult& result) {
  const std::string recording = recordingId(result.recording) + '/';
  return result.id.starts_with(recording) ? result.id.substr(recording.size()) : result.id;
}

std::string variantOf(const CaseResult& result) {
  std::string text = caseNameOf(result) + '/';
  for (const std::string& part :
       {fmt::format("/{}/", isaName(result.isa)), fmt::format("/t{}/", result.threads)}) {
    if (const std::size_t at = text.find(part); at != text.npos) text.erase(at, part.size() - 1);
  }
  text.pop_back();
  return text;
}

CaseResult beginCase(const Case& run, const RecordingReference& recording) {
  CaseResult result;
  result.id = caseId(recording, run);
  result.recording = recording;
  result.algorithm = run.algorithm.id;
  result.family = run.algorithm.family;
  result.isa = run.isa;
  result.vectorised = run.algorithm.traits.vectorised;
  result.threads = run.threads;
  result.device = run.device;
  result.plugin = run.algorithm.plugin;
  result.parameters = parameterValues(*makeInstance(run));
  result.answer = run.answer;
  return result;
}

bool runRepetition(CaseResult& result, CaseRun& run, FrameSource& source, Oracle& oracle,
                   const RunHooks& hooks, bool measured) {
  result.checked = run.checks();
  Repetition repetition;
  repetition.frames.reserve(source.scene().frames);
  try {
    const Frame first = source.rewind();
    FrameCounter counter(result);
    if (run.start(source.scene(), first) && result.setup.empty()) result.setup = run.setup();
    repetition.initialize_ns = run.initializeNanoseconds();
    while (run.running()) {
      const std::optional<Frame> frame = source.next();
      if (!frame) break;
      if (hooks.cancelled && hooks.cancelled()) {
        run.stop();
        return false;
      }
      run.step(*frame);
      if (!run.answered()) break;
      repetition.frames.push_back(run.times());
      counter.count(*frame, run, oracle);
      if (hooks.progress) hooks.progress(frame->index);
    }
    const bool instance_survived = run.hasInstance();
    run.stop();
    repetition.processor = run.report().processor;
    if (measured && instance_survived) result.repetitions.push_back(std::move(repetition));
  } catch (const Cancelled&) {
    return false;
  }
  result.status = run.status();
  result.reason = run.reason();
  result.peak_bytes = run.report().peak_bytes;
  result.conditions.pinned = run.report().pinned;
  return true;
}

CaseResult runCase(const Case& run, FrameSource& source, const RunPolicy& policy, int repetitions) {
  CaseResult result = beginCase(run, {.scene = source.scene()});
  CaseRun case_run(run, policy);
  Oracle oracle;
  for (int repetition = 0; repetition < repetitions && result.status == Status::ok; ++repetition) {
    runRepetition(result, case_run, source, oracle);
  }
  return result;
}

}  // namespace broadmark
