// Repetitions of cases, and what is kept of them.

#include "broadmark/runner.h"

#include <fmt/format.h>

#include <algorithm>

namespace broadmark {
namespace {

/// Adds what the check of one frame found to the case.
void addDifference(CaseResult& result, FrameDifference difference) {
  result.missed_count += difference.missed_count;
  result.false_count += difference.false_count;
  result.allowed_extra_count += difference.allowed_extra_count;
  result.invalid_count += difference.invalid_count;
  if (difference.isMismatch()) result.differences.push_back(std::move(difference));
}

/// Takes one more value into the mean of `count_before`.
void addToMean(double& mean, std::uint64_t value, std::uint64_t count_before) {
  mean += (static_cast<double>(value) - mean) / static_cast<double>(count_before + 1);
}

/// Counts of pairs and of work, of the first repetition: the others do the same.
void countFrame(CaseResult& result, CaseRun& run, std::uint64_t frames_before) {
  addToMean(result.pairs_mean, run.pairs(), frames_before);
  result.pairs_max = std::max(result.pairs_max, run.pairs());
  for (const auto& [name, count] : run.counters()) {
    addToMean(result.counters[name], count, frames_before);
  }
}

/// All frames of one pass; false when cancelled.
bool runFrames(CaseResult& result, Repetition& repetition, CaseRun& run, FrameSource& source,
               Oracle& oracle, const RunHooks& hooks) {
  const bool is_first = result.repetitions.empty();
  const int number = static_cast<int>(result.repetitions.size()) + 1;
  while (run.running()) {
    const std::optional<Frame> frame = source.next();
    if (!frame) return true;
    if (hooks.cancelled && hooks.cancelled()) return false;
    run.step(*frame);
    if (!run.answered()) return true;
    repetition.frames.push_back(run.times());
    if (auto difference = run.check(*frame, oracle)) {
      difference->repetition = number;
      addDifference(result, std::move(*difference));
    }
    if (is_first && run.answered()) countFrame(result, run, repetition.frames.size() - 1);
    if (hooks.progress) hooks.progress(frame->index);
  }
  return true;
}

/// What came of one pass.
struct Pass {
  bool finished = false;  ///< not cancelled
  bool whole = false;     ///< its instance was not lost on the way
  Repetition repetition;
};
Pass runPass(CaseResult& result, CaseRun& run, FrameSource& source, Oracle& oracle,
             const RunHooks& hooks) {
  Pass pass;
  pass.repetition.frames.reserve(source.scene().frames);
  const Frame first = source.rewind();
  if (run.start(source.scene(), first) && result.setup.empty()) result.setup = run.setup();
  pass.repetition.initialize_ns = run.initializeNanoseconds();
  pass.finished = runFrames(result, pass.repetition, run, source, oracle, hooks);
  pass.whole = run.hasInstance();
  run.stop();
  return pass;
}

}  // namespace

std::string caseId(const RecordingReference& recording, const Case& run) {
  const SceneInfo& scene = recording.scene;
  std::string id =
      fmt::format("{}/{}/N{}/F{}", scene.name, scene.object_type, scene.objects, scene.frames);
  if (recording.seed) id += fmt::format("/s{}", *recording.seed);
  for (const auto& [name, value] : recording.swept) {
    if (name != "seed") id += fmt::format("/{}={}", name, value);
  }
  return fmt::format("{}/{}", id, caseName(run));
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
  return result;
}

bool runRepetition(CaseResult& result, CaseRun& run, FrameSource& source, Oracle& oracle,
                   const RunHooks& hooks, bool measured) {
  result.checked = run.checks();
  try {
    Pass pass = runPass(result, run, source, oracle, hooks);
    if (!pass.finished) return false;
    if (measured && pass.whole) result.repetitions.push_back(std::move(pass.repetition));
  } catch (const Cancelled&) {
    return false;
  }
  result.status = run.status();
  result.reason = run.reason();
  result.peak_bytes = run.peakBytes();
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
