// Two boxes in numbers and pictures: their intervals on every axis, and how these changed.
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

/// Their intervals as numbers, to the last digit, and how they lie to each other.
void drawPairTable(Ui& ui, const BoxPair& pair);
/// Their intervals as bars, one axis below the other, all at one scale.
void drawIntervals(Ui& ui, const BoxPair& pair);
/// Per axis and frame the gap (upwards) or overlap (downwards), and which body moved; the last
/// frame is at the right end. Returns the frame that is clicked.
std::optional<std::uint32_t> drawPairHistory(Ui& ui, const PairTrails& trail);

}  // namespace broadmark
