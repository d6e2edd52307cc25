// One case on one world: what goes wrong there.
#pragma once

#include <optional>
#include <vector>

#include "broadmark/fuzz/torture.h"
#include "broadmark/harness/case_run.h"

namespace broadmark {

/// Runs a case on worlds, in one host until something goes wrong in it; then in a new one.
class Trial {
 public:
  /// `make_host` and `cancelled` are borrowed. Throws InputError for a bad parameter.
  Trial(Case run, const ExecutorFactory& make_host, const CancelQuery& cancelled);

  /// All frames of a world; what goes wrong first. With `answers`: appends the digest of each
  /// answer. Throws Cancelled, and InputError for a device that does not exist.
  std::optional<Fault> run(IndexedFrames& world, std::vector<PairDigest>* answers = nullptr);
  /// Whether every pass over a world takes memory and keeps it.
  std::optional<Fault> leak(IndexedFrames& world);
  /// Whether the last world could be run at all.
  [[nodiscard]] bool supported() const { return supported_; }

 private:
  std::optional<Fault> runFrames(IndexedFrames& world, std::vector<PairDigest>* answers);
  std::optional<Fault> judge(const Frame& frame);
  /// Why the host has no instance any more.
  std::optional<Fault> ended(std::uint32_t frame);
  /// After so many passes.
  std::optional<std::uint64_t> heapAfter(IndexedFrames& world, int passes);

  Case case_;
  const ExecutorFactory& make_host_;
  const CancelQuery& cancelled_;
  std::optional<CaseRun> run_;
  bool supported_ = true;
};

}  // namespace broadmark
