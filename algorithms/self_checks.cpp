// Self-checks: broad phases that find nothing, to measure the harness itself.
//
// `none` returns at once: its times are the overhead of the harness. `time-validator` busy-waits a
// known time in each phase, which must be reported.

#include <chrono>
#include <vector>

#include "variants.h"

namespace broadmark::self_checks {
namespace {

/// Directly on BroadPhase: a layer's copies and buffers would be included in the times.
class None : public BroadPhase {
 public:
  void initialize(const SceneInfo&, const Frame&, ExecutionContext&) override {}
  void updateObjects(const Frame&) override {}
  void searchOverlaps() override {}
  [[nodiscard]] PairRuns overlaps() const override { return {}; }
};

class TimeValidator final : public None {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"phase_us", "time that each phase waits, in microseconds", &phase_us_, 0, 1'000'000});
  }
  void updateObjects(const Frame&) override { wait(); }
  void cleanCache() override { wait(); }
  void updateStructures() override { wait(); }
  void searchOverlaps() override { wait(); }

 private:
  void wait() const {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::microseconds(phase_us_);
    while (Clock::now() < end) {
    }
  }

  std::int64_t phase_us_ = 1000;
};

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {.family = "self-check",
                            .traits = {.finds_pairs = false},
                            .description = {.principle = "none",
                                            .time = "O(1)",
                                            .space = "O(1)",
                                            .source = "The original Broadmark"}};
  return {variantOf<None>(family, "none", "does nothing: shows the overhead of the harness"),
          variantOf<TimeValidator>(family, "time-validator",
                                   "waits a known time in each phase: checks the clock")};
}

}  // namespace broadmark::self_checks
