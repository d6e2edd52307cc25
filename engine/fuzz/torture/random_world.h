// Random worlds.
#pragma once

#include <memory>
#include <string>

#include "broadmark/fuzz/torture.h"
#include "torture/inputs.h"

namespace broadmark {

struct RandomWorld {
  std::string name;  ///< of its generator
  std::unique_ptr<IndexedFrames> frames;
};

/// A small world, with at least one frame after the initial pose.
RandomWorld randomWorld(inputs::Random& random, const TortureOptions& options);

/// A world of 70,000 bodies: more than 16 bits can number.
RandomWorld largeWorld(inputs::Random& random);
/// A world of few bodies with that many frames.
RandomWorld longWorld(inputs::Random& random, std::uint32_t frames);

/// The same world with the bodies in random order.
std::unique_ptr<IndexedFrames> shuffled(inputs::Random& random, IndexedFrames& frames);

}  // namespace broadmark
