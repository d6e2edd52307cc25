// The inner loop, one for each instruction set: a box against those in the cells around it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "broadmark/aabb.h"
#include "broadmark/execution.h"

namespace broadmark::tide {

/// A body in a cell: its box, with numbers in the fourth components.
struct Entry {
  Aabb box;

  [[nodiscard]] std::uint32_t body() const { return std::bit_cast<std::uint32_t>(box.min[3]); }
  /// Of its last move.
  [[nodiscard]] std::uint32_t move() const { return std::bit_cast<std::uint32_t>(box.max[3]); }
  void set(const Aabb& to, std::uint32_t body, std::uint32_t move) {
    box = to;
    box.min[3] = std::bit_cast<float>(body);
    setMove(move);
  }
  void setMove(std::uint32_t move) { box.max[3] = std::bit_cast<float>(move); }
};

/// The entries of a cell.
struct Run {
  const Entry* entries;
  std::uint32_t count;
};

/// Most hits in one call.
inline constexpr std::uint32_t kMostHits = 128;

struct Kernels {
  /// Finds the entries that overlap a box, or have a move of at least `moving`; writes where they
  /// are, and one more that means nothing. The runs have at most kMostHits entries in all.
  std::size_t (*find_hits)(const Run* begin, const Run* end, const Aabb& box, std::uint32_t moving,
                           const Entry** hits);
};

/// The kernels for an instruction set, which this processor must support.
const Kernels& kernels(Isa isa);

}  // namespace broadmark::tide
