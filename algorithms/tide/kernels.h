// The inner loop of looking for bodies, one for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/execution.h"
#include "tide/lines.h"

namespace broadmark::tide {

/// The bodies in some places of a line, met by a look.
struct Hit {
  const Line* line;
  std::uint32_t look;
  std::uint32_t places;  ///< a bit each
};

struct Kernels {
  struct Found {
    std::size_t hits;
    std::size_t followed;
  };
  /// Looks into `count` lines for bounds that reach what is wanted in each; looks are numbered from
  /// `first` on. Lists the lines where there are any, and the looks whose lines are followed by
  /// others. There is room for `count` of both.
  Found (*look)(const Line* const* lines, const Bounds* least, std::size_t count,
                std::uint32_t first, Hit* hits, std::uint32_t* followed);
};

/// The kernels for an instruction set, which this processor must support.
const Kernels& kernels(Isa isa);

}  // namespace broadmark::tide
