// Adapters between an algorithm of limited capabilities and a scene that needs more. Composite
// algorithms may use them, too.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "broadmark/broad_phase.h"

namespace broadmark {

/// Whether bodies appear and disappear in the scene, as images of a periodic world do, or some
/// pairs are unwanted in some frames.
bool isChangingWorld(const SceneInfo& scene);

/// Adapts an algorithm that handles only boxes, in varying number: passes only
/// active bodies to it, and drops unwanted pairs. Every frame must list the changes since the
/// frame before. The filter may change.
std::unique_ptr<BroadPhase> compacted(std::unique_ptr<BroadPhase> algorithm);

/// Adapts an algorithm that handles absent bodies and a fixed filter itself to a filter that
/// changes: its filter changes for absent bodies only.
std::unique_ptr<BroadPhase> withFilterChanges(std::unique_ptr<BroadPhase> algorithm);

/// Creates an instance for a scene, with the case's parameters.
using InstanceMaker = std::function<std::unique_ptr<BroadPhase>(const SceneInfo&)>;

/// Adapts algorithms to a periodic world. The images of bodies are further bodies, which appear and
/// disappear, of a scene without a filter: `make` creates an instance for such a scene. Pairs of
/// images are mapped back, and unwanted pairs dropped. Every frame must list the changes since the
/// frame before.
std::unique_ptr<BroadPhase> withImages(const SceneInfo& scene, const InstanceMaker& make);

/// The number of worlds with bodies in the scene.
std::size_t worldCount(const SceneInfo& scene);

/// Adapts an algorithm that would mix the bodies of several worlds at the same place:
/// one instance per world. With `concurrent`, instances may be called at the same time.
std::unique_ptr<BroadPhase> perWorld(const SceneInfo& scene, const InstanceMaker& make,
                                     bool concurrent);

/// Adds events to an algorithm that reports only the pairs of each frame.
std::unique_ptr<BroadPhase> withEvents(std::unique_ptr<BroadPhase> algorithm);

}  // namespace broadmark
