// Scene parameters as JSON, in files of their own and in the sidecars of recordings.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "scenes/simulation.h"

namespace broadmark {

inline constexpr std::string_view kSceneParametersSchema = "broadmark-scene-parameters/1";
inline constexpr std::string_view kBakeSchema = "broadmark-bake/1";

/// {"schema": …, "scene": its id, "parameters": {all by name}}
nlohmann::ordered_json sceneParametersJson(Simulation&, std::string_view schema);

}  // namespace broadmark
