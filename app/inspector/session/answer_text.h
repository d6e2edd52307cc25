// What a view shows, in words: whose answer it is, and what the oracle finds beside it.
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
  std::string where;   ///< "frame 12, recording: a.aabbs"; "" where there is only one view
  std::string owner;   ///< "faulty"
  std::string answer;  ///< "faulty reports 352 pairs"
  std::string beside;  ///< "the oracle finds 353: 1 missed"
  std::string pair;    ///< of two selected bodies: who finds them; "" of any other number
};

/// `chosen`: the number of the lane that is to be shown; it may have no answer for this frame.
AnswerText answerText(const Snapshot& snapshot, const std::vector<LaneReport>& lanes, int chosen,
                      std::span<const std::uint32_t> selection);

/// "live simulation: Brownian"; "" for nothing.
std::string sourceText(const FrameProviderRequest* footage);

}  // namespace broadmark
