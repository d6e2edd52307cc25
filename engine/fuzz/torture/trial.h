// Trials of a case on a world, and the resulting faults.
#pragma once

#include <optional>
#include <vector>

#include "broadmark/fuzz/torture.h"
#include "broadmark/harness/case_run.h"

namespace broadmark {

/// Runs a case on worlds: in one executor until a fault, then in a new one.
class Trial {
 public:
  /// The options are borrowed. Throws InputError for a bad parameter.
  Trial(Case test_case, const TortureOptions& options);

  /// Runs all frames of a world; returns the first fault. With `answers`: appends the digest of
  /// each answer. Throws Cancelled, and InputError for a device that does not exist.
  std::optional<Fault> run(IndexedFrames& world, std::vector<PairDigest>* answers = nullptr);
  /// Detects memory leaked by every pass over a world.
  std::optional<Fault> leak(IndexedFrames& world);
  /// Whether the case supports the last world.
  [[nodiscard]] bool supported() const { return supported_; }

 private:
  std::optional<Fault> runFrames(IndexedFrames& world, std::vector<PairDigest>* answers);
  std::optional<Fault> judge(const Frame& frame);
  /// The fault that ended the instance, if any.
  std::optional<Fault> faultOfStatus(std::uint32_t frame);
  /// The allocated memory after `passes` passes.
  std::optional<std::uint64_t> heapAfter(IndexedFrames& world, int passes);

  Case case_;
  const TortureOptions& options_;
  std::optional<CaseRun> run_;
  bool supported_ = true;
};

}  // namespace broadmark
