// Finding the smallest part of a recording on which something still fails: an algorithm's answer,
// for one.
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
  std::uint64_t trials = 0;  ///< runs so far
  std::size_t bodies = 0;    ///< of the smallest part found
  std::size_t frames = 0;    ///< likewise, the initial pose not counted
};

struct ShrinkOptions {
  std::function<void(const ShrinkProgress&)> progress;  ///< told after each trial
  CancelQuery cancelled;
  /// A part of the recording that takes no more than this is held in memory; a larger one is read
  /// again for each trial.
  std::size_t memory_bytes = std::size_t{256} << 20;
  ExecutorFactory make_host = makeLocalHost;  ///< where the trials of a case run
  std::string subject = "it";                 ///< what fails, in messages; of a case its name
};

/// A part of a recording on which something fails.
struct ShrunkPart {
  Part part;  ///< in the recording's own numbers
  std::uint64_t trials = 0;
  /// Whether no single body, frame, absence, layer, world or tag can be left out; false when
  /// cancelled.
  bool minimal = false;
};

/// Whether a part of the recording fails, in its last frame.
using FailingTrial = std::function<bool(IndexedFrames& part)>;
/// Bodies to look at first, in the recording's numbers. Asked again after a trial of all bodies.
using SuspectQuery = std::function<std::vector<std::uint32_t>()>;

/// Where to look first: the bodies of the first wrong pair of these `bodies`; none if there is
/// none.
std::vector<std::uint32_t> suspectsOf(const FrameDifference&, std::size_t bodies);

/// The smallest part of `source` for which fails(part) is true; frame `last` becomes its last one.
/// Deterministic if the trials are. options.make_host is not used here.
///
/// Cancelled: the best part so far. Throws InputError when frames 0…last as a whole do not fail, or
/// for a bad recording.
ShrunkPart shrinkPart(IndexedFrames& source, std::uint32_t last, const SuspectQuery& suspects,
                      const FailingTrial& fails, const ShrinkOptions& options = {});

/// A part of a recording on which a case fails.
struct ShrunkCase : ShrunkPart {
  FrameDifference difference;  ///< of the last frame, numbered as in the part
};

/// The smallest part of `source` on which `run` still fails as it does in frame `known.frame`,
/// which becomes the part's last frame. The case fails where the answer for that frame is a
/// mismatch of any kind. Each trial is a pass of a fresh instance over all frames of a part; one
/// that throws counts as not failing. Time limits are off. Deterministic if the algorithm is.
///
/// The pairs listed in `known` only tell where to look first. Cancelled: the best part so far.
/// Throws InputError when the case does not fail in that frame, when the algorithm is a self-check
/// that finds no pairs, or for a bad recording.
ShrunkCase shrinkCase(const Case& run, IndexedFrames& source, const FrameDifference& known,
                      const ShrinkOptions& options = {});

}  // namespace broadmark
