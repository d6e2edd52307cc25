// The inner loops of Tide, one table of them for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/execution.h"
#include "tide/search.h"

namespace broadmark::tide {

/// Some bodies met by a look.
struct Hit {
  std::uint64_t places;  ///< a byte for each line, in which there is a bit for each place
  std::uint32_t look;
};

struct Kernels {
  /// Takes over where bodies are, and writes their searches, of which there is room for two each.
  /// Returns how many these are. `boxes` and `of_bodies` have one for each body there is.
  std::size_t (*add_searches)(Cells& cells, std::uint32_t frame, const std::uint32_t* bodies,
                              std::size_t count, const Aabb* boxes, Body* of_bodies,
                              Search* searches);

  /// Sets a look for who on a level may overlap an extent, all but its numbers, and returns true if
  /// that is nearly as always: two cells on each axis at most, all of them in the bulk.
  bool (*set_look)(const Cells& cells, const Line* lines, const Extent& extent, std::uint32_t level,
                   Look& look);

  struct Found {
    std::size_t hits;
    std::size_t followed;
  };

  /// Looks for bounds within limits; looks are numbered from `first` on. Lists the looks that find
  /// any, and those with lines that are followed by others, which are told by bits of
  /// Look::kFollowed. There is room for `count` of both.
  Found (*look)(const Look* looks, std::size_t count, std::uint32_t first, Hit* hits,
                Hit* followed);
};

/// The kernels for an instruction set, which this processor must support.
const Kernels& kernels(Isa isa);

}  // namespace broadmark::tide
