// Finding the smallest part of a recording on which an algorithm still answers wrongly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "broadmark/case_host.h"
#include "broadmark/oracle.h"
#include "broadmark/sub_recording.h"

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
  HostMaker make_host = makeLocalHost;  ///< where the trials run
};

/// A part of a recording on which a case fails in the last frame.
struct ShrunkCase {
  Part part;                   ///< in the recording's own numbers
  FrameDifference difference;  ///< of the last frame, numbered as in the part
  std::uint64_t trials = 0;
  /// Whether no single body, frame, absence, layer, world or tag can be left out; false when
  /// cancelled.
  bool minimal = false;
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
