// Parameters as JSON: in files of scene parameters, sidecars and authored scenes.
#pragma once

#include <string_view>

#include "broadmark/json_fields.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark {

/// {"schema": …, "scene": its id, "parameters": {all by name}}
Json sceneParametersJson(Simulation&, std::string_view schema);

/// All parameters of an object by name, numbers as numbers.
Json parametersJson(Parametrised&);
/// Sets parameters from such an object. Throws InputError for an unknown name or an invalid value.
void setParametersFromJson(Parametrised&, const Json& values);

}  // namespace broadmark
