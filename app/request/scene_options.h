// What is simulated when a source is a scene or a batch is baked.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "broadmark/parameters.h"

namespace broadmark {

struct SceneOptions {
  std::vector<std::uint32_t> objects;  ///< numbers of bodies, ascending; empty: the scene's default
  std::vector<std::string> object_types;  ///< empty: the scene's default
  /// Scene parameters given by options of their own (--frames, --seed, …), by parameter name. A
  /// text may hold several values (sweep.h).
  ParameterValues parameters;
  /// Kinds of recordings to keep; the first is run on. Empty: recordingExtension() of the scene.
  std::vector<std::string> recorders;
};

}  // namespace broadmark
