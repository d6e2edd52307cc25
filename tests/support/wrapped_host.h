// A host that forwards all calls, for tests that override or observe one of them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "broadmark/harness/case_executor.h"

namespace broadmark::tests {

class WrappedHost : public CaseExecutor {
 public:
  explicit WrappedHost(const Case& test_case) : inner_(makeInProcessExecutor(test_case, {})) {}

  std::int64_t start(const SceneInfo& scene, const Frame& first) override {
    return inner_->start(scene, first);
  }
  StepResult step(const Frame& frame) override { return inner_->step(frame); }
  void stop() override { inner_->stop(); }
  PairDigest digest() override { return inner_->digest(); }
  PairRuns answer() override { return inner_->answer(); }
  PairEvents events() override { return inner_->events(); }
  Counts counters() override { return inner_->counters(); }
  Counts setup() override { return inner_->setup(); }
  RecordedDrawing structure() override { return inner_->structure(); }
  std::string validate() override { return inner_->validate(); }

 private:
  std::unique_ptr<CaseExecutor> inner_;
};

/// Calls `before_step` before each frame.
class WatchedHost final : public WrappedHost {
 public:
  WatchedHost(const Case& test_case, const std::function<void()>& before_step)
      : WrappedHost(test_case), before_step_(before_step) {}

  StepResult step(const Frame& frame) override {
    before_step_();
    return WrappedHost::step(frame);
  }

 private:
  const std::function<void()>& before_step_;
};

/// Reports the given times for initialisation and frames, whatever the machine.
class HostOfTimes final : public WrappedHost {
 public:
  struct Times {
    std::int64_t initialize_ns = 0;
    std::function<FrameTimes(std::uint32_t frame)> of_frame = [](std::uint32_t) {
      return FrameTimes();
    };
  };
  HostOfTimes(const Case& test_case, Times times)
      : WrappedHost(test_case), times_(std::move(times)) {}

  std::int64_t start(const SceneInfo& scene, const Frame& first) override {
    WrappedHost::start(scene, first);
    return times_.initialize_ns;
  }
  StepResult step(const Frame& frame) override {
    StepResult result = WrappedHost::step(frame);
    result.times = times_.of_frame(frame.index);
    return result;
  }

 private:
  Times times_;
};

}  // namespace broadmark::tests
