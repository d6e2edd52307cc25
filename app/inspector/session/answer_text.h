// Labels of a view: its answer, and the comparison with the oracle's.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "inspector/run/run_thread.h"

namespace broadmark {

struct AnswerText {
  enum class Verdict { oracle, right, wrong, unchecked };
  Verdict verdict = Verdict::oracle;
  std::string where;       ///< "frame 12, recording: a.aabbs"; "" if there is only one view
  std::string owner;       ///< "faulty"
  std::string answer;      ///< "faulty reports 352 pairs"
  std::string comparison;  ///< "the oracle finds 353: 1 missed"
  std::string pair;  ///< which algorithms find the two selected bodies; "" unless two are selected
  std::string waiting;  ///< what delays the requested frame; "": nothing
};

/// `chosen`: number of the selected track, which may have no answer for this frame.
AnswerText answerText(const Snapshot& snapshot, const std::vector<TrackReport>& tracks, int chosen,
                      std::span<const std::uint32_t> selection);

/// "live simulation: Brownian"; "" for null.
std::string sourceText(const FrameProviderRequest* source);

}  // namespace broadmark
