#include "broadmark/recordings/periodic_frames.h"

#include <fmt/format.h>

#include <utility>

#include "broadmark/error.h"
#include "broadmark/exact_sum.h"
#include "broadmark/recordings/mapped_frames.h"
#include "recording_file.h"

namespace broadmark {
namespace {

/// The scene in a periodic world: along periodic axes its world is the box.
SceneInfo sceneIn(PeriodicBox box, SceneInfo scene) {
  scene.periodic = box;
  for (int axis = 0; axis < 3; ++axis) {
    if (!box.repeats(axis)) continue;
    scene.world.min[axis] = floatBelow({box.min[axis], 0});
    scene.world.max[axis] = floatAbove({box.max[axis], 0});
  }
  return scene;
}

}  // namespace

SceneInfo periodicScene(SceneInfo scene, const std::string& box) {
  if (box == kStatedPeriodicBox) {
    const PeriodicBox stated = scene.periodic;
    if (stated.repeats()) return sceneIn(stated, std::move(scene));
    throw InputError(fmt::format(
        "{}: states no periodic box: give it, as in --periodic=0:10,0:10,-", scene.name));
  }
  if (scene.periodic.repeats()) {
    throw InputError(
        fmt::format("{}: is periodic already: {}: --periodic without a box is expected", scene.name,
                    periodicText(scene.periodic)));
  }
  scene.name = suffixedName(scene, kPeriodicSuffix);
  try {
    return sceneIn(parsePeriodic(box), std::move(scene));
  } catch (const InputError& error) {
    throw InputError(fmt::format("--periodic: {}", error.what()));
  }
}

std::unique_ptr<IndexedFrames> periodicFrames(std::unique_ptr<IndexedFrames> frames,
                                              const std::string& box) {
  SceneInfo scene = periodicScene(frames->scene(), box);
  const auto wrap = [periodic = scene.periodic](const Aabb& own) { return wrapped(own, periodic); };
  return std::make_unique<MappedFrames>(std::move(frames), std::move(scene), wrap);
}

}  // namespace broadmark
