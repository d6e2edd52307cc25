// Finds the smallest failing part of a recording: with a wrong answer of an algorithm, say.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "broadmark/harness/case_executor.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/recordings/sub_recording.h"

namespace broadmark {

struct ShrinkProgress {
  std::uint64_t trials = 0;
  std::size_t bodies = 0;  ///< of the smallest part found
  std::size_t frames = 0;  ///< without the initial pose
};

struct ShrinkOptions {
  std::function<void(const ShrinkProgress&)> progress;  ///< called after each trial
  CancelQuery cancelled;
  /// Parts up to this size are held in memory; larger ones are read again for each trial.
  std::size_t memory_bytes = std::size_t{256} << 20;
  ExecutorFactory make_executor = makeInProcessExecutor;  ///< for the trials of a case
  std::string subject = "it";  ///< the failing subject in messages: a case's name
};

/// A failing part of a recording.
struct ShrunkPart {
  Selection part;  ///< in the recording's ids
  std::uint64_t trials = 0;
  /// Whether no single body, frame, absence, layer, world or tag can be removed; false when
  /// cancelled.
  bool minimal = false;
};

/// Returns whether a part of the recording fails, in its last frame.
using FailingTrial = std::function<bool(IndexedFrames& part)>;
/// Returns bodies to try first, by the recording's ids. Called again after a trial of all bodies.
using SuspectQuery = std::function<std::vector<std::uint32_t>()>;

/// The bodies of the first wrong pair, if its ids are below `bodies`: suspects to try first.
std::vector<std::uint32_t> suspectsOf(const FrameDifference&, std::size_t bodies);

/// Finds the smallest part of `source` with fails(part); its last frame is frame `last`.
/// Deterministic if the trials are. Does not use options.make_executor.
///
/// Returns the best part so far when cancelled. Throws InputError if frames 0…last as a whole do
/// not fail, or for a bad recording.
ShrunkPart shrinkPart(IndexedFrames& source, std::uint32_t last, const SuspectQuery& suspects,
                      const FailingTrial& fails, const ShrinkOptions& options = {});

/// A part of a recording on which a case fails.
struct ShrunkCase : ShrunkPart {
  FrameDifference difference;  ///< of the last frame, with the part's ids
};

/// Finds the smallest part of `source` on which `test_case` still fails in frame `known.frame`, the
/// part's last frame. The case fails if the answer for that frame is a mismatch of any kind. Each
/// trial is a pass of a fresh instance over all frames of a part; an exception counts as no
/// failure. Time limits are off. Deterministic if the algorithm is.
///
/// The pairs listed in `known` only guide the search. Returns the best part so far when cancelled.
/// Throws InputError when the case does not fail in that frame, when the algorithm is a self-check
/// that finds no pairs, or for a bad recording.
ShrunkCase shrinkCase(const Case& test_case, IndexedFrames& source, const FrameDifference& known,
                      const ShrinkOptions& options = {});

/// As shrinkCase(), for a case that ends with an error in frame `frame`: a crash or an exception.
/// options.make_executor must survive it.
ShrunkPart shrinkFailure(const Case& test_case, IndexedFrames& source, std::uint32_t frame,
                         const ShrinkOptions& options = {});

}  // namespace broadmark
