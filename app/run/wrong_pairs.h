// Wrong pairs and small failing recordings as text.
#pragma once

#include <string>

#include "broadmark/harness/oracle.h"
#include "broadmark/recordings/sub_recording.h"

namespace broadmark {

/// "missed 3-7, 4-9; false 1-2": at most 100 pairs of each kind, in this order.
std::string wrongPairsText(const FrameDifference&);

/// The boxes of the last two frames of a part of `whole`, one box per line, each line with its
/// newline; "" with more than four bodies.
std::string smallPartText(IndexedFrames& whole, const Selection& part);

}  // namespace broadmark
