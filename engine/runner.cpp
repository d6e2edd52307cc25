// Repetitions of cases, and what is kept of them.

#include "broadmark/runner.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

#include "broadmark/files.h"

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
void countFrame(CaseResult& result, const BroadPhase& algorithm, std::uint64_t frames_before) {
  const std::uint64_t pairs = pairCount(algorithm.overlaps());
  addToMean(result.pairs_mean, pairs, frames_before);
  result.pairs_max = std::max(result.pairs_max, pairs);
  algorithm.visitCounters([&](std::string_view name, std::uint64_t count) {
    addToMean(result.counters[std::string(name)], count, frames_before);
  });
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
    if (is_first) countFrame(result, run.algorithm(), repetition.frames.size() - 1);
    if (hooks.progress) hooks.progress(frame->index);
  }
  return true;
}

}  // namespace

std::string caseId(const RecordingReference& recording, const Case& run) {
  const SceneInfo& scene = recording.scene;
  return fmt::format("{}/{}/N{}/F{}{}/{}", scene.name, scene.object_type, scene.objects,
                     scene.frames, recording.seed ? fmt::format("/s{}", *recording.seed) : "",
                     caseName(run));
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
  Repetition repetition;
  repetition.frames.reserve(source.scene().frames);
  const Frame first = source.rewind();
  if (run.start(source.scene(), first) && result.setup.empty()) {
    run.algorithm().visitSetup(
        [&](std::string_view name, std::uint64_t count) { result.setup.emplace(name, count); });
  }
  repetition.initialize_ns = run.initializeNanoseconds();
  const bool finished = runFrames(result, repetition, run, source, oracle, hooks);
  const bool broken = !run.hasInstance();
  run.stop();
  if (!finished) return false;
  result.status = run.status();
  result.reason = run.reason();
  if (measured && !broken) result.repetitions.push_back(std::move(repetition));
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

std::optional<std::uint64_t> measurePeakBytes(const Case& run, FrameSource& source) {
  // The threads of a device's driver do not live on in a child, which would wait for them.
  if (run.algorithm.traits.on_device) return std::nullopt;
  int channel[2];
  if (::pipe(channel) != 0) return std::nullopt;
  // Free memory that the child inherits is within its peak from the start, and would hide what the
  // algorithm takes.
  ::malloc_trim(0);
  const pid_t child = ::fork();
  if (child < 0) return std::nullopt;
  if (child == 0) {
    const auto peak_kib = [] {
      rusage usage{};
      ::getrusage(RUSAGE_SELF, &usage);
      return static_cast<std::uint64_t>(usage.ru_maxrss);
    };
    std::uint64_t growth = 0;
    try {
      const Frame first = source.rewind();
      const std::uint64_t before = peak_kib();
      CaseRun child_run(run, RunPolicy::unlimited(CheckMode::off));
      child_run.start(source.scene(), first);
      while (const auto frame = child_run.running() ? source.next() : std::nullopt) {
        child_run.step(*frame);
      }
      if (child_run.status() != Status::ok) ::_exit(1);
      growth = (peak_kib() - before) * 1024;
      if (::write(channel[1], &growth, sizeof growth) != sizeof growth) ::_exit(1);
    } catch (...) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  const FileDescriptor read_end(channel[0]);
  { const FileDescriptor write_end(channel[1]); }
  std::uint64_t growth = 0;
  const bool complete = ::read(read_end.get(), &growth, sizeof growth) == sizeof growth;
  int status = 0;
  ::waitpid(child, &status, 0);
  return complete ? std::optional(growth) : std::nullopt;
}

}  // namespace broadmark
