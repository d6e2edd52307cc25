// Running cases: the clock, the checks, the verdict.

#include "broadmark/runner.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <mutex>

#include "broadmark/files.h"
#include "broadmark/error.h"

namespace broadmark {
namespace {

using Clock = std::chrono::steady_clock;

std::int64_t nanoseconds(Clock::duration duration) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
}

/// Judged on the running mean once this many frames are known.
constexpr std::size_t kFramesBeforeLimit = 3;

/// Adds what the check of one frame found to the case.
void addDifference(CaseResult& result, FrameDifference difference) {
  result.missed += difference.missed_count;
  result.extra += difference.extra_count;
  result.invalid += difference.invalid_count;
  if (!difference.isMismatch()) return;
  if (result.status == Status::ok) {
    result.status = Status::mismatch;
    result.reason =
        fmt::format("frame {}: {} missed, {} false, {} invalid", difference.frame,
                    difference.missed_count, difference.forbidden_count, difference.invalid_count);
  }
  result.differences.push_back(std::move(difference));
}

/// A case that failed in one way stays failed: later repetitions do not mend it.
void fail(CaseResult& result, Status status, std::string reason) {
  if (result.status != Status::ok) return;
  result.status = status;
  result.reason = std::move(reason);
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

/// One pass; false when cancelled.
bool runFrames(CaseResult& result, Repetition& repetition, CaseInstance& instance,
               FrameSource& source, Oracle& oracle, const RunOptions& options, bool count) {
  std::int64_t total_ns = 0;
  const int number = static_cast<int>(result.repetitions.size()) + 1;
  while (const std::optional<Frame> frame = source.next()) {
    if (options.cancelled && options.cancelled()) return false;
    const FrameTimes times = runFrame(instance.algorithm(), *frame);
    repetition.frames.push_back(times);
    if (result.checked && frame->index >= options.first_checked) {
      FrameDifference difference = instance.check(*frame, oracle, options.check);
      difference.repetition = number;
      addDifference(result, std::move(difference));
    }
    if (count) countFrame(result, instance.algorithm(), repetition.frames.size() - 1);
    if (options.progress) options.progress(frame->index);

    total_ns += times[Phase::total];
    const double mean_s =
        static_cast<double>(total_ns) * 1e-9 / static_cast<double>(repetition.frames.size());
    if (repetition.frames.size() >= kFramesBeforeLimit && mean_s > options.frame_limit_seconds) {
      fail(result, Status::timeout,
           fmt::format("{:.3g} s/frame after frame {}: over the limit of {:.3g} s", mean_s,
                       frame->index, options.frame_limit_seconds));
      return true;
    }
  }
  return true;
}

/// Libraries with process-wide state run one at a time, each under its own lock.
std::mutex& mutexOf(std::string_view name) {
  static std::mutex guard;
  static std::map<std::string, std::mutex, std::less<>> mutexes;
  const std::lock_guard hold(guard);
  return mutexes[std::string(name)];
}

}  // namespace

FrameTimes runFrame(BroadPhase& algorithm, const Frame& frame) {
  FrameTimes times;
  const auto start = Clock::now();
  algorithm.updateObjects(frame);
  const auto updated = Clock::now();
  algorithm.cleanCache();
  const auto cleaned = Clock::now();
  algorithm.updateStructures();
  const auto structured = Clock::now();
  algorithm.searchOverlaps();
  const auto end = Clock::now();
  times[Phase::update_objects] = nanoseconds(updated - start);
  times[Phase::clean_cache] = nanoseconds(cleaned - updated);
  times[Phase::update_structures] = nanoseconds(structured - cleaned);
  times[Phase::search_overlaps] = nanoseconds(end - structured);
  const TransferTimes transfers = algorithm.transfers();
  times[Phase::upload] = transfers.upload_ns;
  times[Phase::download] = transfers.download_ns;
  times[Phase::total] = nanoseconds(end - start);
  return times;
}

CaseInstance::CaseInstance(const Case& run, const SceneInfo& scene)
    : execution_(run.threads, run.isa, run.device), algorithm_(run.algorithm.create()) {
  setParameters(*algorithm_, run.parameters);
  capabilities_ = algorithm_->capabilities();
  if (run.algorithm.vectorised && !isaSupported(run.isa)) {
    throw UnsupportedError(fmt::format("this processor has no {}", isaName(run.isa)));
  }
  if (scene.objects > capabilities_.max_objects) {
    throw UnsupportedError(fmt::format("at most {} bodies, the scene has {}",
                                       capabilities_.max_objects, scene.objects));
  }
}

std::int64_t CaseInstance::initialize(const SceneInfo& scene, const Frame& first) {
  const auto start = Clock::now();
  algorithm_->initialize(scene, first, execution_);
  return nanoseconds(Clock::now() - start);
}

FrameDifference CaseInstance::check(const Frame& frame, Oracle& oracle, CheckMode mode) const {
  const PairRuns answer = algorithm_->overlaps();
  if (mode == CheckMode::hash && capabilities_.margin == 0 &&
      digest(answer) == oracle.pairDigest(frame)) {
    return {.frame = frame.index};
  }
  return findDifference(answer, oracle.pairs(frame), frame, capabilities_.margin);
}

std::string caseName(const Case& run) {
  std::string name = run.algorithm.id;
  if (run.algorithm.vectorised) name += fmt::format("/{}", isaName(run.isa));
  if (run.algorithm.parallel) name += fmt::format("/t{}", run.threads);
  for (const auto& [key, value] : run.parameters) name += fmt::format("/{}={}", key, value);
  return name;
}

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
  result.vectorised = run.algorithm.vectorised;
  result.threads = run.threads;
  result.device = run.device;
  result.plugin = run.algorithm.plugin;
  const auto algorithm = run.algorithm.create();
  setParameters(*algorithm, run.parameters);
  result.parameters = parameterValues(*algorithm);
  return result;
}

bool runRepetition(CaseResult& result, const Case& run, FrameSource& source, Oracle& oracle,
                   const RunOptions& options, bool measured) {
  result.checked = options.check != CheckMode::off && run.algorithm.finds_pairs;
  Repetition repetition;
  repetition.frames.reserve(source.scene().frames);
  try {
    std::unique_lock<std::mutex> alone;
    const std::string_view exclusive = run.algorithm.create()->capabilities().exclusive;
    if (!exclusive.empty()) alone = std::unique_lock(mutexOf(exclusive));
    CaseInstance instance(run, source.scene());
    const Frame first = source.rewind();
    repetition.initialize_ns = instance.initialize(source.scene(), first);
    const double initialize_s = static_cast<double>(repetition.initialize_ns) * 1e-9;
    if (initialize_s > options.initialize_limit_seconds) {
      fail(result, Status::timeout,
           fmt::format("initialisation took {:.3g} s: over the limit of {:.3g} s", initialize_s,
                       options.initialize_limit_seconds));
    } else if (!runFrames(result, repetition, instance, source, oracle, options,
                          result.repetitions.empty())) {
      return false;
    }
  } catch (const InputError&) {
    throw;
  } catch (const UnsupportedError& unsupported) {
    fail(result, Status::unsupported, unsupported.what());
    return true;
  } catch (const std::exception& error) {
    fail(result, Status::error, error.what());
    return true;
  }
  if (measured) result.repetitions.push_back(std::move(repetition));
  return true;
}

CaseResult runCase(const Case& run, FrameSource& source, const RunOptions& options,
                   int repetitions) {
  CaseResult result = beginCase(run, {.scene = source.scene()});
  Oracle oracle;
  for (int repetition = 0; repetition < repetitions && result.status == Status::ok; ++repetition) {
    if (!runRepetition(result, run, source, oracle, options)) break;
  }
  return result;
}

std::optional<std::uint64_t> measurePeakBytes(const Case& run, FrameSource& source) {
  // The threads of a device's driver do not live on in a child, which would wait for them.
  if (run.algorithm.on_device) return std::nullopt;
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
      CaseInstance instance(run, source.scene());
      instance.initialize(source.scene(), first);
      while (const auto frame = source.next()) runFrame(instance.algorithm(), *frame);
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
