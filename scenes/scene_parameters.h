// Scene parameters as JSON, in files of their own and in the sidecars of recordings.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "broadmark/scenes/simulation.h"

namespace broadmark {

inline constexpr std::string_view kSceneParametersSchema = "broadmark-scene-parameters/1";
inline constexpr std::string_view kBakeSchema = "broadmark-bake/1";

/// {"schema": …, "scene": its id, "parameters": {all by name}}
nlohmann::ordered_json sceneParametersJson(Simulation&, std::string_view schema);

/// All parameters of an object by name, numbers as numbers.
nlohmann::ordered_json parametersJson(Parametrised&);
/// Sets them from such an object. Throws InputError for an unknown one or a bad value.
void setParametersFromJson(Parametrised&, const nlohmann::ordered_json& values);

/// A text for messages, control characters escaped.
std::string onOneLine(const std::string& text);

}  // namespace broadmark
