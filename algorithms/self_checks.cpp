// Self-checks: broad phases that find nothing, to measure the harness itself.
//
// `none` returns at once: what it "costs" is the overhead of the harness. `time-validator`
// busy-waits a known time in each phase: what is reported must be that. (The original's None,
// TimeValidator.)

#include <chrono>
#include <vector>

#include "broadmark/algorithm.h"

namespace broadmark::self_checks {
namespace {

class None : public BroadPhase {
 public:
  void initialize(const SceneInfo&, const Frame&, Execution&) override {}
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

template <class T>
Algorithm selfCheck(std::string id, std::string original, std::string summary) {
  return {.id = std::move(id),
          .family = "self-check",
          .summary = std::move(summary),
          .finds_pairs = false,
          .original_ids = {{std::move(original), {}}},
          .create = [] { return std::make_unique<T>(); },
          .principle = "none",
          .exactness = "finds nothing",
          .time = "O(1)",
          .space = "O(1)",
          .source = "the original Broadmark"};
}

}  // namespace

std::vector<Algorithm> variants() {
  return {selfCheck<None>("none", "None", "does nothing: shows the overhead of the harness"),
          selfCheck<TimeValidator>("time-validator", "TimeValidator",
                                   "waits a known time in each phase: checks the clock")};
}

}  // namespace broadmark::self_checks
