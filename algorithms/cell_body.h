// Bodies in grid cells, such that each pair is reported in one cell only: after the home and
// phantom cells of S. Le Grand, "Broad-Phase Collision Detection with CUDA", GPU Gems 3 (2007),
// chapter 32.
#pragma once

#include <cstdint>

namespace broadmark {

/// A body in a cell that it overlaps: the body's id and, in the top three bits, one phantom bit per
/// axis, set if the body begins in an earlier cell on that axis.
///
/// Two overlapping bodies may share several cells. On each axis, the body that begins later has a
/// clear phantom bit in the first shared cell, and both have it set in all further ones. So exactly
/// one shared cell has no phantom bit in common: the home cell, which reports the pair. This needs
/// neither a hash table nor another access to the boxes.
using CellBody = std::uint32_t;

inline constexpr int kPhantomShift = 29;
inline constexpr CellBody kMaxCellBodies = CellBody{1} << kPhantomShift;
inline constexpr CellBody kBodyIdMask = kMaxCellBodies - 1;

constexpr CellBody phantomBit(int axis) { return CellBody{1} << (kPhantomShift + axis); }
constexpr CellBody phantomBits(bool x, bool y, bool z) {
  return (CellBody{x} | CellBody{y} << 1 | CellBody{z} << 2) << kPhantomShift;
}
constexpr std::uint32_t bodyId(CellBody body) { return body & kBodyIdMask; }
/// Whether the common cell is the pair's home cell.
constexpr bool isHomeCellPair(CellBody a, CellBody b) { return (a & b & ~kBodyIdMask) == 0; }

}  // namespace broadmark
