// Bodies that lie in several cells, and how each of their pairs is still reported once.
#pragma once

#include <cstdint>

namespace broadmark {

/// A body in one of the cells that it touches: its number and, in the three highest bits, a mark
/// for each axis on which this cell is not the first that the body touches.
///
/// Two overlapping bodies may share several cells. On each axis the first cell they share is the
/// first of at least one of them (whichever begins later), and no other shared cell is the first of
/// either. So in exactly one shared cell they have no mark in common, and there they are reported.
/// That takes neither a hash nor a look at the boxes.
using MarkedBody = std::uint32_t;

inline constexpr int kMarkShift = 29;
inline constexpr MarkedBody kMaxMarkedBodies = MarkedBody{1} << kMarkShift;
inline constexpr MarkedBody kNumberMask = kMaxMarkedBodies - 1;

/// The mark for an axis, already in its place.
constexpr MarkedBody axisMark(int axis) { return MarkedBody{1} << (kMarkShift + axis); }
/// The marks of a cell.
constexpr MarkedBody cellMarks(bool x, bool y, bool z) {
  return (MarkedBody{x} | MarkedBody{y} << 1 | MarkedBody{z} << 2) << kMarkShift;
}
constexpr std::uint32_t bodyNumber(MarkedBody body) { return body & kNumberMask; }
/// Whether this is the shared cell in which the two are reported.
constexpr bool reportedHere(MarkedBody a, MarkedBody b) { return (a & b & ~kNumberMask) == 0; }

}  // namespace broadmark
