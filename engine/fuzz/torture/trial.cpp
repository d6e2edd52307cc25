#include "torture/trial.h"

#include <fmt/format.h>

#include "broadmark/error.h"
#include "broadmark/fuzz/shrink.h"
#include "broadmark/harness/memory_limit.h"

namespace broadmark {

Trial::Trial(Case test_case, const TortureOptions& options)
    : case_(std::move(test_case)), options_(options) {}

std::optional<Fault> Trial::run(IndexedFrames& world, std::vector<PairDigest>* answers) {
  supported_ = true;
  if (!run_) {
    run_.emplace(case_, RunPolicy::unlimited(CheckMode::hash), options_.make_executor,
                 options_.cancelled);
  }
  std::optional<Fault> fault = runFrames(world, answers);
  if (fault || !supported_) run_.reset();
  return fault;
}

std::optional<Fault> Trial::runFrames(IndexedFrames& world, std::vector<PairDigest>* answers) {
  if (!run_->start(world.scene(), world.rewind())) return faultOfStatus(0);
  while (const std::optional<Frame> frame = world.next()) {
    if (options_.cancelled && options_.cancelled()) throw Cancelled();
    if (!run_->step(*frame)) return faultOfStatus(frame->index);
    if (std::optional<Fault> fault = judge(*frame)) return fault;
    if (answers != nullptr) answers->push_back(digest(run_->answer()));
    if (!run_->hasInstance()) return faultOfStatus(frame->index);
  }
  run_->stop();
  return faultOfStatus(world.scene().frames);
}

std::optional<Fault> Trial::judge(const Frame& frame) {
  Oracle oracle(0);
  const std::optional<FrameDifference> difference = run_->check(frame, oracle);
  if (difference && difference->isMismatch()) {
    return Fault{FaultKind::wrong_answer, frame.index, mismatchText(*difference),
                 suspectsOf(*difference, frame.boxes.size())};
  }
  if (!run_->hasInstance()) return std::nullopt;
  const std::string violation = run_->validate();
  if (violation.empty()) return std::nullopt;
  return Fault{FaultKind::invariant_violation, frame.index, violation};
}

std::optional<Fault> Trial::faultOfStatus(std::uint32_t frame) {
  switch (run_->status()) {
    case Status::ok:
      return std::nullopt;
    case Status::unsupported:
      supported_ = false;
      return std::nullopt;
    case Status::timeout:
      return Fault{FaultKind::hang, frame, run_->reason()};
    default:
      return Fault{FaultKind::failure, frame, run_->reason()};
  }
}

std::optional<std::uint64_t> Trial::heapAfter(IndexedFrames& world, int passes) {
  for (int i = 0; i < passes; ++i) {
    if (run(world) || !supported_) return std::nullopt;
  }
  return options_.own_process ? heapBytes() : run_->report().heap_bytes;
}

std::optional<Fault> Trial::leak(IndexedFrames& world) {
  // Caches of libraries and malloc eventually stop growing. A leak grows with the passes.
  constexpr int kFirstPasses = 4;
  constexpr std::array kPasses = {4, 8, 16, 32, 64};
  constexpr std::uint64_t kMinBytes = 16;  // smallest allocation
  constexpr double kMinGrowth = 1.5;
  std::optional<std::uint64_t> before = heapAfter(world, kFirstPasses);
  std::uint64_t growth = 0;
  for (const int passes : kPasses) {
    const std::optional<std::uint64_t> after = heapAfter(world, passes);
    if (!before || !after || *after < *before + kMinBytes * static_cast<std::uint64_t>(passes) ||
        static_cast<double>(*after - *before) < kMinGrowth * static_cast<double>(growth)) {
      return std::nullopt;
    }
    growth = *after - *before;
    before = after;
  }
  return Fault{FaultKind::leak, world.scene().frames,
               fmt::format("each pass leaks about {} bytes", growth / kPasses.back())};
}

}  // namespace broadmark
