// The clock, the limits and the verdict.

#include "broadmark/case_run.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/exclusive_use.h"

namespace broadmark {
namespace {

using Clock = std::chrono::steady_clock;

/// The running mean is judged once this many frames are known.
constexpr std::uint32_t kFramesBeforeLimit = 3;

std::int64_t nanoseconds(Clock::duration duration) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
}

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Runs the four phases and times them. Nothing else happens inside the clock.
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

/// "" or why a case cannot run here on a scene.
std::string obstacle(const Case& run, const SceneInfo& scene) {
  const AlgorithmTraits& traits = run.algorithm.traits;
  if (traits.vectorised && !isaSupported(run.isa)) {
    return fmt::format("this processor has no {}", isaName(run.isa));
  }
  if (scene.objects > traits.max_objects) {
    return fmt::format("at most {} bodies, the scene has {}", traits.max_objects, scene.objects);
  }
  return {};
}

}  // namespace

CaseRun::CaseRun(Case run, RunPolicy policy)
    : case_(std::move(run)),
      policy_(policy),
      next_(makeInstance(case_)),
      margin_(next_->margin()) {}

CaseRun::~CaseRun() {
  const ExclusiveUse alone(case_.algorithm.traits.exclusive);
  instance_.reset();
  execution_.reset();
}

void CaseRun::fail(Status status, std::string reason) {
  if (status_ == Status::ok) {
    status_ = status;
    reason_ = std::move(reason);
  } else if (status != Status::mismatch && !ended_early_) {
    reason_ += fmt::format("; then {}", reason);  // a mismatch does not say why a pass ended
  }
  ended_early_ |= status != Status::mismatch;
}

template <class Call>
bool CaseRun::attempt(std::uint32_t frame, Call&& call) {
  try {
    const ExclusiveUse alone(case_.algorithm.traits.exclusive);
    call();
    return true;
  } catch (const InputError&) {
    stop();
    throw;
  } catch (const UnsupportedError& unsupported) {
    fail(Status::unsupported, unsupported.what());
  } catch (const std::exception& error) {
    fail(Status::error, fmt::format("frame {}: {}", frame, error.what()));
  }
  stop();
  return false;
}

bool CaseRun::start(const SceneInfo& scene, const Frame& first) {
  stop();
  frames_ = 0;
  total_ns_ = 0;
  initialize_ns_ = 0;
  if (std::string reason = obstacle(case_, scene); !reason.empty()) {
    fail(Status::unsupported, std::move(reason));
    return false;
  }
  const bool initialized = attempt(first.index, [&] {
    if (!execution_) execution_.emplace(case_.threads, case_.isa, case_.device);
    instance_ = next_ ? std::move(next_) : makeInstance(case_);
    const auto start = Clock::now();
    instance_->initialize(scene, first, *execution_);
    initialize_ns_ = nanoseconds(Clock::now() - start);
  });
  if (!initialized) return false;
  if (seconds(initialize_ns_) <= policy_.initialize_limit_seconds) return true;
  fail(Status::timeout, fmt::format("initialisation took {:.3g} s: over the limit of {:.3g} s",
                                    seconds(initialize_ns_), policy_.initialize_limit_seconds));
  ended_ = true;
  return false;
}

bool CaseRun::step(const Frame& frame) {
  if (!attempt(frame.index, [&] { times_ = runFrame(*instance_, frame); })) return false;
  ++frames_;
  total_ns_ += times_[Phase::total];
  const double mean_s = seconds(total_ns_) / frames_;
  if (frames_ < kFramesBeforeLimit || mean_s <= policy_.frame_limit_seconds) return true;
  fail(Status::timeout, fmt::format("{:.3g} s/frame after frame {}: over the limit of {:.3g} s",
                                    mean_s, frame.index, policy_.frame_limit_seconds));
  ended_ = true;
  return false;
}

std::optional<FrameDifference> CaseRun::check(const Frame& frame, Oracle& oracle) {
  if (!checks()) return std::nullopt;
  const PairRuns answer = instance_->overlaps();
  if (policy_.check == CheckMode::hash && margin_ == 0 &&
      digest(answer) == oracle.pairDigest(frame.boxes)) {
    return FrameDifference{.frame = frame.index};
  }
  FrameDifference difference = findDifference(answer, oracle.pairs(frame.boxes), frame, margin_);
  if (difference.isMismatch()) {
    fail(Status::mismatch, fmt::format("frame {}: {}", frame.index, mismatchText(difference)));
  }
  return difference;
}

void CaseRun::stop() {
  ended_ = false;
  if (instance_ == nullptr) return;
  const ExclusiveUse alone(case_.algorithm.traits.exclusive);
  instance_.reset();
}

}  // namespace broadmark
