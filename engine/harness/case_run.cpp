// Limits and statuses.

#include "broadmark/harness/case_run.h"

#include <fmt/format.h>

#include <utility>

#include "broadmark/error.h"

namespace broadmark {
namespace {

/// Frames before the running mean is compared with the limit.
constexpr std::uint32_t kFramesBeforeLimit = 3;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

CaseRun::CaseRun(Case test_case, RunPolicy policy, const ExecutorFactory& make_host,
                 CancelQuery cancelled)
    : case_(std::move(test_case)),
      policy_(policy),
      margin_(makeInstance(case_)->margin()),
      host_(make_host(case_, std::move(cancelled))) {}

void CaseRun::fail(Status status, std::string reason) {
  if (status_ == Status::ok) {
    status_ = status;
    reason_ = std::move(reason);
  } else if (status != Status::mismatch && !ended_early_) {
    reason_ += fmt::format("; then {}", reason);  // a mismatch does not explain why a pass ended
  }
  ended_early_ |= status != Status::mismatch;
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
  filter_ = scene.filter;
  frame_ = first.index;
  frames_ = 0;
  total_ns_ = 0;
  initialize_ns_ = 0;
  has_instance_ = true;  // so that stop() is called even if start fails halfway
  followed_.clear();
  const bool started = attempt([&] {
    initialize_ns_ = host_->start(scene, changed_bodies_.complete(first));
    followEvents(first);
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
  const Frame complete = changed_bodies_.complete(frame);
  changed_count_ = complete.changed->size();
  const bool stepped = attempt([&] {
    last_ = host_->step(complete);
    followEvents(frame);
  });
  if (!stepped) return false;
  ++frames_;
  total_ns_ += last_.times[Phase::total];
  const double mean_s = seconds(total_ns_) / frames_;
  if (frames_ < kFramesBeforeLimit || mean_s <= policy_.frame_limit_seconds) return true;
  fail(Status::timeout, fmt::format("{:.3g} s/frame after frame {}: over the limit of {:.3g} s",
                                    mean_s, frame.index, policy_.frame_limit_seconds));
  ended_ = true;
  return false;
}

void CaseRun::followEvents(const Frame& frame) {
  if (answersEvents() && checks()) followed_.apply(host_->events(), frame.boxes.size());
}

std::optional<FrameDifference> CaseRun::check(const Frame& frame, Oracle& oracle) {
  if (!checks()) return std::nullopt;
  if (policy_.check == CheckMode::hash && margin_ == 0 && followed_.impossible().empty()) {
    PairDigest found;
    if (!attempt([&] { found = answersEvents() ? digest(followed_.pairs()) : host_->digest(); }))
      return std::nullopt;
    if (found == oracle.pairDigest(frame.boxes, filter_))
      return FrameDifference{.frame = frame.index};
  }
  PairRuns given;
  if (!attempt([&] { given = answersEvents() ? followed_.pairs() : host_->answer(); }))
    return std::nullopt;
  FrameDifference difference =
      findDifference(given, oracle.pairs(frame.boxes, filter_), frame, margin_, filter_);
  difference.addInvalid(followed_.impossible());
  if (difference.isMismatch()) {
    fail(Status::mismatch, atFrame(mismatchText(difference)));
  }
  return difference;
}

void CaseRun::stop() {
  ended_ = false;
  if (!std::exchange(has_instance_, false)) return;
  attempt([&] { host_->stop(); });
}

template <class Answer>
Answer CaseRun::ask(Answer (CaseExecutor::*question)()) {
  Answer answer;
  attempt([&] { answer = (host_.get()->*question)(); });
  return answer;
}

PairRuns CaseRun::answer() {
  return answersEvents() ? followed_.pairs() : ask(&CaseExecutor::answer);
}
Counts CaseRun::counters() { return ask(&CaseExecutor::counters); }
Counts CaseRun::setup() { return ask(&CaseExecutor::setup); }
RecordedDrawing CaseRun::structure() { return ask(&CaseExecutor::structure); }
std::string CaseRun::validate() { return ask(&CaseExecutor::validate); }

}  // namespace broadmark
