// What stands between an algorithm that knows little and a scene that asks for more. Algorithms
// that are made of others may use them, too.
#pragma once

#include <memory>

#include "broadmark/broad_phase.h"

namespace broadmark {

/// Whether bodies come and go in the scene, or not all pairs are wanted.
bool isChangingWorld(const SceneInfo& scene);

/// For an algorithm that knows only boxes, and whose frames may each have another number of these:
/// shows it those that take part, and leaves pairs out that are not wanted. It must be told of
/// every frame what changed since the one before it.
std::unique_ptr<BroadPhase> compacted(std::unique_ptr<BroadPhase> algorithm);

/// For an algorithm that knows only the pairs of each frame: answers with events, too.
std::unique_ptr<BroadPhase> withEvents(std::unique_ptr<BroadPhase> algorithm);

}  // namespace broadmark
