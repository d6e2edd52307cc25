// Scene parameters as JSON and back. Values have the types of the parameters.

#include "scene_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "broadmark/error.h"
#include "broadmark/names.h"
#include "broadmark/scenes/authored_simulation.h"

namespace broadmark {
namespace {

/// A number as text; any other value as a short text for messages.
std::string textOf(const Json& value) {
  if (value.is_array()) return "[…]";
  return value.is_object() ? "{…}" : compactJson(value);
}

void setFromJson(const Parameter& parameter, const Json& value) {
  if (std::holds_alternative<bool*>(parameter.value)) {
    if (!value.is_boolean()) {
      throw InputError(
          fmt::format("parameter {}: '{}' is not true or false", parameter.name, textOf(value)));
    }
    *std::get<bool*>(parameter.value) = value.get<bool>();
  } else if (std::holds_alternative<std::string*>(parameter.value)) {
    if (!value.is_string()) {
      throw InputError(
          fmt::format("parameter {}: '{}' is not a string", parameter.name, textOf(value)));
    }
    *std::get<std::string*>(parameter.value) = value.get<std::string>();
  } else if (std::holds_alternative<Choice*>(parameter.value) && value.is_string()) {
    setParameter(parameter, onOneLine(value.get<std::string>()));
  } else {
    // A JSON string keeps its quotes here, so that it is not parsed as a number.
    setParameter(parameter, textOf(value));
  }
}

/// The keys of a file with this schema.
std::vector<std::string> knownKeys(const std::string& schema) {
  std::vector<std::string> keys = {"schema", "scene", "parameters"};
  if (schema == kBakeSchema) keys.insert(keys.end(), {"hash", "input_hash"});
  return keys;
}

void requireKnown(const std::string& kind, const std::string& name,
                  const std::vector<std::string>& known) {
  if (std::ranges::find(known, name) == known.end()) {
    throw InputError(unknownName(kind, onOneLine(name), known));
  }
}

/// Messages omit the file: the caller adds it.
std::unique_ptr<Simulation> simulationFrom(const Json& json) {
  const auto text = [&](const char* key) {
    const auto field = json.find(key);
    if (field == json.end()) throw InputError(fmt::format("'{}' is missing", key));
    if (!field->is_string()) throw InputError(fmt::format("{}: a string is expected", key));
    return field->get<std::string>();
  };
  const std::string schema = text("schema");
  if (!describesScene(schema)) {
    throw InputError(fmt::format("schema: '{}' is not {}, {} or {}", onOneLine(schema),
                                 kSceneParametersSchema, kBakeSchema,
                                 scenes::kAuthoredSceneSchema));
  }
  for (const auto& [key, value] : json.items()) requireKnown("key", key, knownKeys(schema));

  const auto parameters = json.find("parameters");
  if (parameters != json.end() && !parameters->is_object()) {
    throw InputError("parameters: an object is expected");
  }
  std::string engine;  // read first: it determines the other parameters
  if (parameters != json.end() && parameters->contains("engine")) {
    const Json& value = parameters->at("engine");
    engine = onOneLine(value.is_string() ? value.get<std::string>() : textOf(value));
  }
  const std::string scene = text("scene");
  if (scene == kAuthoredSceneId) {
    throw InputError(
        fmt::format("belongs to a recording of an authored scene: use the scene's own file instead "
                    "(\"schema\": \"{}\")",
                    scenes::kAuthoredSceneSchema));
  }
  auto simulation = makeSimulation(onOneLine(scene), engine);
  if (parameters != json.end()) setParametersFromJson(*simulation, *parameters);
  return simulation;
}

}  // namespace

Json parametersJson(Parametrised& object) {
  Json parameters = Json::object();
  object.visitParameters([&](const Parameter& parameter) {
    parameters[std::string(parameter.name)] = std::visit(
        [](const auto* value) -> Json {
          if constexpr (std::is_same_v<decltype(value), const Choice*>) {
            return value->value;
          } else {
            return *value;
          }
        },
        parameter.value);
  });
  return parameters;
}

void setParametersFromJson(Parametrised& object, const Json& values) {
  std::vector<std::string> known;
  object.visitParameters([&](const Parameter& parameter) {
    known.emplace_back(parameter.name);
    const auto value = values.find(known.back());
    if (value != values.end()) setFromJson(parameter, *value);
  });
  for (const auto& [key, value] : values.items()) requireKnown("parameter", key, known);
}

Json sceneParametersJson(Simulation& simulation, std::string_view schema) {
  return {{"schema", schema},
          {"scene", simulation.listing().id},
          {"parameters", parametersJson(simulation)}};
}

bool describesScene(std::string_view schema) {
  return schema == kSceneParametersSchema || schema == kBakeSchema ||
         schema == scenes::kAuthoredSceneSchema;
}

std::unique_ptr<Simulation> parseSceneParameters(std::string_view json, std::string_view name) {
  if (jsonSchema(json, name) == scenes::kAuthoredSceneSchema) {
    return scenes::makeAuthoredSimulation(scenes::parseAuthoredScene(json, name), name);
  }
  const Json parsed = parseJson(json, name);
  try {
    if (!parsed.is_object()) throw InputError("a JSON object is expected");
    return simulationFrom(parsed);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", name, error.what()));
  }
}

std::string formatSceneParameters(Simulation& simulation) {
  if (auto* authored = dynamic_cast<scenes::SceneDocument*>(&simulation)) {
    return scenes::formatAuthoredScene(authored->document());
  }
  return formatJson(sceneParametersJson(simulation, kSceneParametersSchema), 2);
}

}  // namespace broadmark
