// Adapters between an algorithm of limited capabilities and a scene that needs more. Composite
// algorithms may use them, too.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "broadmark/broad_phase.h"

namespace broadmark {

/// Whether bodies appear and disappear in the scene, or some pairs are unwanted.
bool isChangingWorld(const SceneInfo& scene);

/// For an algorithm that handles only boxes, in a number that may vary between frames: passes only
/// participating bodies on, and drops unwanted pairs. Every frame must say what changed since the
/// one before.
std::unique_ptr<BroadPhase> compacted(std::unique_ptr<BroadPhase> algorithm);

/// The number of worlds with bodies in the scene.
std::size_t worldCount(const SceneInfo& scene);

/// Makes an instance for a single-world scene, with the case's parameters.
using InstanceMaker = std::function<std::unique_ptr<BroadPhase>(const SceneInfo& world)>;

/// Several worlds at one place, for an algorithm that would mix their bodies up in one structure:
/// an instance for each world. With `concurrent`, instances may be called at the same time.
std::unique_ptr<BroadPhase> perWorld(const SceneInfo& scene, const InstanceMaker& make,
                                     bool concurrent);

/// For an algorithm that reports only the pairs of each frame: adds events.
std::unique_ptr<BroadPhase> withEvents(std::unique_ptr<BroadPhase> algorithm);

}  // namespace broadmark
