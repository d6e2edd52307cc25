// Limits and statuses.

#include "broadmark/harness/case_run.h"

#include <fmt/format.h>

#include <utility>

#include "broadmark/error.h"

namespace broadmark {
namespace {

/// Frames before the running mean is compared with the limit.
constexpr std::uint32_t kFramesBeforeLimit = 3;

/// Throws UnsupportedError unless a count holds all instructions of the case, and only these:
/// threads that wait for each other execute some, too.
void requireCountable(const Case& test_case) {
  if (test_case.algorithm.traits.on_device) {
    throw UnsupportedError("instructions of a device are not counted");
  }
  if (test_case.threads > 1) {
    throw UnsupportedError("instructions are counted on one thread only (--threads 1)");
  }
}

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

CaseRun::CaseRun(Case test_case, RunPolicy policy, const ExecutorFactory& make_executor,
                 CancelQuery cancelled)
    : case_(std::move(test_case)),
      policy_(policy),
      margin_(makeInstance(case_)->margin()),
      executor_(make_executor(case_, std::move(cancelled))) {}

void CaseRun::fail(Status status, std::string reason) {
  if (status_ == Status::ok) {
    status_ = status;
    reason_ = std::move(reason);
  } else if (status != Status::mismatch && !failed_) {
    reason_ += fmt::format("; then {}", reason);  // a mismatch does not explain the end of a pass
  }
  failed_ |= status != Status::mismatch;
}

std::string CaseRun::atFrame(std::string_view what) const {
  return fmt::format("frame {}: {}", frame_, what);
}

template <class Call>
bool CaseRun::attempt(Call&& call) {
  try {
    call();
    return true;
  } catch (const InputError&) {
    stop();
    throw;
  } catch (const Cancelled&) {
    stop();
    throw;
  } catch (const UnsupportedError& unsupported) {
    fail(Status::unsupported, unsupported.what());
  } catch (const HardLimitError& limit) {
    fail(Status::timeout, atFrame(limit.what()));
  } catch (...) {
    fail(Status::error, atFrame(currentErrorText()));
  }
  stop();
  return false;
}

bool CaseRun::start(const SceneInfo& scene, const Frame& first) {
  stop();
  scene_ = scene;
  frame_ = first.index;
  frames_ = 0;
  total_ns_ = 0;
  initialize_ns_ = 0;
  has_instance_ = true;  // stop() must be called even if start() fails halfway
  accumulated_.clear();
  const bool started = attempt([&] {
    if (policy_.counted_by) requireCountable(case_);
    initialize_ns_ = executor_->start(scene, change_detector_.complete(first));
    accumulateEvents(first);
  });
  if (!started) return false;
  if (seconds(initialize_ns_) <= policy_.initialize_limit_seconds) return true;
  fail(Status::timeout, fmt::format("initialisation took {:.3g} s: over the limit of {:.3g} s",
                                    seconds(initialize_ns_), policy_.initialize_limit_seconds));
  ended_ = true;
  return false;
}

bool CaseRun::step(const Frame& frame) {
  frame_ = frame.index;
  const Frame complete = change_detector_.complete(frame);
  changed_count_ = complete.changed->size();
  const bool stepped = attempt([&] {
    last_ = executor_->step(complete);
    accumulateEvents(frame);
  });
  if (!stepped) return false;
  ++frames_;
  ended_ = frames_ >= policy_.max_frames;
  total_ns_ += last_.times[Phase::total];
  const double mean_s = seconds(total_ns_) / frames_;
  if (frames_ < kFramesBeforeLimit || mean_s <= policy_.frame_limit_seconds) return !ended_;
  fail(Status::timeout, fmt::format("{:.3g} s/frame after frame {}: over the limit of {:.3g} s",
                                    mean_s, frame.index, policy_.frame_limit_seconds));
  ended_ = true;
  return false;
}

void CaseRun::accumulateEvents(const Frame& frame) {
  if (answersEvents() && checks()) accumulated_.apply(executor_->events(), frame.boxes.size());
}

std::optional<FrameDifference> CaseRun::check(const Frame& frame, Oracle& oracle) {
  if (!checks()) return std::nullopt;
  if (isQuery(case_.answer)) return checkHits(frame, oracle);
  const CollisionFilter& filter = frame.filterIn(scene_);
  if (policy_.check == CheckMode::hash && margin_ == 0 && accumulated_.impossible().empty()) {
    PairDigest found;
    if (!attempt(
            [&] { found = answersEvents() ? digest(accumulated_.pairs()) : executor_->digest(); }))
      return std::nullopt;
    if (found == oracle.pairDigest(frame.boxes, filter, scene_.periodic))
      return FrameDifference{.frame = frame.index};
  }
  PairRuns answer;
  if (!attempt([&] { answer = answersEvents() ? accumulated_.pairs() : executor_->answer(); }))
    return std::nullopt;
  FrameDifference difference =
      findDifference(answer, oracle.pairs(frame.boxes, filter, scene_.periodic), frame, margin_,
                     filter, scene_.periodic);
  difference.addInvalid(accumulated_.impossible());
  if (difference.isMismatch()) {
    fail(Status::mismatch, atFrame(mismatchText(difference)));
  }
  return difference;
}

std::optional<FrameDifference> CaseRun::checkHits(const Frame& frame, Oracle& oracle) {
  PairRuns answer;
  if (!attempt([&] { answer = executor_->answer(); })) return std::nullopt;
  FrameDifference difference = findDifference(answer, oracle.hits(case_.answer, frame), frame);
  if (difference.isMismatch()) fail(Status::mismatch, atFrame(mismatchText(difference)));
  return difference;
}

void CaseRun::stop() {
  ended_ = false;
  if (!std::exchange(has_instance_, false)) return;
  attempt([&] { executor_->stop(); });
}

template <class Answer>
Answer CaseRun::query(Answer (CaseExecutor::*method)()) {
  Answer answer;
  attempt([&] { answer = (executor_.get()->*method)(); });
  return answer;
}

PairRuns CaseRun::answer() {
  return answersEvents() ? accumulated_.pairs() : query(&CaseExecutor::answer);
}
Counts CaseRun::counters() { return query(&CaseExecutor::counters); }
Counts CaseRun::setup() { return query(&CaseExecutor::setup); }
RecordedDrawing CaseRun::structure() { return query(&CaseExecutor::structure); }
std::string CaseRun::validate() { return query(&CaseExecutor::validate); }

}  // namespace broadmark
