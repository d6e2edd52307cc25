// Worlds made up at random.
#pragma once

#include <memory>
#include <string>

#include "broadmark/fuzz/torture.h"
#include "torture/inputs.h"

namespace broadmark {

struct RandomWorld {
  std::string name;  ///< of its kind
  std::unique_ptr<IndexedFrames> frames;
};

/// A small world, of one frame or more after the initial pose.
RandomWorld randomWorld(inputs::Random& random, const TortureOptions& options);

/// The same with the bodies in another order.
std::unique_ptr<IndexedFrames> shuffled(inputs::Random& random, IndexedFrames& frames);

}  // namespace broadmark
