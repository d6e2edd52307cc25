// Drawings of a pair of boxes: the intervals on each axis, and their history.
#pragma once

#include <cstdint>
#include <optional>

#include "inspector/session/wrong_pair.h"
#include "inspector/ui/ui.h"

namespace broadmark {

/// Two bodies and their boxes in one frame.
struct BoxPair {
  Pair bodies;
  Aabb a;
  Aabb b;
};

/// Draws a table of the exact intervals, with the gap or overlap on each axis.
void drawPairTable(Ui& ui, const BoxPair& pair);
/// Draws the intervals as bars, one axis below the other, all at one scale.
void drawIntervals(Ui& ui, const BoxPair& pair);
/// Draws per axis and frame the gap (upwards) or overlap (downwards), and per body the frames in
/// which it moved; the last frame is at the right end. Returns the clicked frame.
std::optional<std::uint32_t> drawPairHistory(Ui& ui, const PairTrails& trail);

}  // namespace broadmark
