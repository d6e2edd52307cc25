// What stands between an algorithm that knows little and a scene that asks for more. Algorithms
// that are made of others may use them, too.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "broadmark/broad_phase.h"

namespace broadmark {

/// Whether bodies come and go in the scene, or not all pairs are wanted.
bool isChangingWorld(const SceneInfo& scene);

/// For an algorithm that knows only boxes, and whose frames may each have another number of these:
/// shows it those that take part, and leaves pairs out that are not wanted. It must be told of
/// every frame what changed since the one before it.
std::unique_ptr<BroadPhase> compacted(std::unique_ptr<BroadPhase> algorithm);

/// In how many worlds the scene's bodies are.
std::size_t worldCount(const SceneInfo& scene);

/// Makes an instance for a scene that is one world, with the case's parameters.
using InstanceMaker = std::function<std::unique_ptr<BroadPhase>(const SceneInfo& world)>;

/// Several worlds at one place, for an algorithm that would mix their bodies up in one structure:
/// an instance for each world. With `concurrent`, several may be called at once.
std::unique_ptr<BroadPhase> perWorld(const SceneInfo& scene, const InstanceMaker& make,
                                     bool concurrent);

/// For an algorithm that knows only the pairs of each frame: answers with events, too.
std::unique_ptr<BroadPhase> withEvents(std::unique_ptr<BroadPhase> algorithm);

}  // namespace broadmark
