// Authored scenes to JSON, directly from the bodies: scenes may have millions of them. O(length).

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "authoring/faults.h"
#include "broadmark/json_fields.h"
#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/authored_simulation.h"
#include "scene_parameters.h"

namespace broadmark::scenes {
namespace {

/// The shortest text that round-trips, with the sign of zero.
template <class Number>
void append(std::string& text, Number value) {
  text +=
      value == 0 && std::signbit(static_cast<double>(value)) ? "-0.0" : fmt::format("{}", value);
}

template <std::size_t count>
void append(std::string& text, const std::array<float, count>& values) {
  std::string_view separator = "[";
  for (const float value : values) {
    text += std::exchange(separator, ", ");
    append(text, value);
  }
  text += ']';
}

/// Whether values must be written even if equal to the default: negative zero equals zero.
bool hasSigns(std::span<const float> values) {
  return std::ranges::any_of(values, [](float value) { return std::signbit(value); });
}
bool hasSigns(double /*not a float*/) { return false; }

void append(std::string& text, const AuthoredBody& body) {
  if (const auto* sphere = std::get_if<SphereShape>(&body.shape)) {
    text += "{\"sphere\": ";
    append(text, sphere->radius);
  } else {
    text += "{\"box\": ";
    append(text, edgesOf(body.shape));
  }
  visitProperties(body, [&](std::string_view key, const auto& value, const auto& default_value) {
    if (value == default_value && !hasSigns(value) && key != "position") return;
    text += fmt::format(", \"{}\": ", key);
    append(text, value);
  });
  text += '}';
}

/// The stated parameters on one line, numbers as numbers.
void appendParameters(std::string& text, const ParameterValues& parameters) {
  AuthoredParameters typed(parameters);
  const Json all = parametersJson(typed);
  std::string_view separator;
  for (const auto& [name, value] : all.items()) {
    if (!parameters.contains(name)) continue;
    text += fmt::format("{}\"{}\": {}", separator, name, compactJson(value));
    separator = ", ";
  }
}

/// Colliding layers and triggers, unless at their defaults.
void appendLayers(std::string& text, const AuthoredScene& scene) {
  std::vector<std::string> pairs;
  std::vector<std::size_t> triggers;
  for (std::size_t a = 0; a < LayerMatrix::kLayers; ++a) {
    if ((scene.triggers >> a & 1) != 0) triggers.push_back(a);
    for (std::size_t b = a; b < LayerMatrix::kLayers; ++b) {
      if (scene.collide.collide(a, b)) pairs.push_back(fmt::format("[{}, {}]", a, b));
    }
  }
  if (scene.collide != LayerMatrix::all()) {
    text += fmt::format(",\n\"collide\": [{}]", fmt::join(pairs, ", "));
  }
  if (!triggers.empty()) text += fmt::format(",\n\"triggers\": [{}]", fmt::join(triggers, ", "));
}

}  // namespace

std::string formatAuthoredScene(const AuthoredScene& scene) {
  requireValid(scene);
  constexpr std::size_t kTypicalBody = 100;
  std::string text;
  text.reserve(kTypicalBody * scene.bodies.size());
  text += fmt::format("{{\n\"schema\": \"{}\",\n\"name\": {},\n\"world\": {{\"min\": ",
                      kAuthoredSceneSchema, compactJson(scene.name));
  const auto& [min, max] = scene.world;
  append(text, Vec3{min[0], min[1], min[2]});
  text += ", \"max\": ";
  append(text, Vec3{max[0], max[1], max[2]});
  text += "},\n\"parameters\": {";
  appendParameters(text, scene.parameters);
  text += '}';
  appendLayers(text, scene);
  text += ",\n\"bodies\": [";
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    text += i == 0 ? "\n" : ",\n";
    append(text, scene.bodies[i]);
  }
  text += "\n]\n}\n";
  return text;
}

}  // namespace broadmark::scenes
