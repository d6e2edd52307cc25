// Authored scenes to JSON, straight from the bodies: scenes may have millions of them. O(length).

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "authoring/faults.h"
#include "broadmark/json_fields.h"
#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/authored_simulation.h"
#include "scene_parameters.h"

namespace broadmark::scenes {
namespace {

/// The shortest text that reads back as the same float, with the sign of zero.
void append(std::string& text, float value) {
  if (value == 0 && std::signbit(value)) {
    text += "-0.0";
  } else {
    text += fmt::format("{}", value);
  }
}

void append(std::string& text, std::string_view key, std::span<const float> values) {
  text += fmt::format("\"{}\": [", key);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += ", ";
    append(text, values[i]);
  }
  text += ']';
}

/// The same, but nothing when the values are the default bit for bit.
template <std::size_t count>
void appendUnless(const std::array<float, count>& standard, std::string& text, std::string_view key,
                  const std::array<float, count>& values) {
  using Bits = std::array<std::uint32_t, count>;
  if (std::bit_cast<Bits>(values) == std::bit_cast<Bits>(standard)) return;
  text += ", ";
  append(text, key, values);
}

void append(std::string& text, const AuthoredBody& body) {
  const AuthoredBody standard;
  text += '{';
  if (const auto* sphere = std::get_if<SphereShape>(&body.shape)) {
    text += "\"sphere\": ";
    append(text, sphere->radius);
  } else {
    append(text, "box", edgesOf(body.shape));
  }
  text += ", ";
  append(text, "position", body.pose.position);
  appendUnless(standard.pose.rotation, text, "rotation", body.pose.rotation);
  appendUnless(standard.linear_velocity, text, "velocity", body.linear_velocity);
  appendUnless(standard.angular_velocity, text, "angular_velocity", body.angular_velocity);
  if (body.mass != standard.mass) {
    text += fmt::format(", \"mass\": {}", body.mass);
  }
  if (body.frozen) text += ", \"frozen\": true";
  const auto append_unless = [&](unsigned usual, std::string_view key, unsigned value) {
    if (value == usual) return;
    text += fmt::format(", \"{}\": {}", key, value);
  };
  append_unless(standard.layer, "layer", body.layer);
  append_unless(standard.appears, "appears", body.appears);
  append_unless(standard.vanishes, "vanishes", body.vanishes);
  append_unless(standard.group, "group", body.group);
  text += '}';
}

/// The stated parameters on one line, numbers as numbers.
void appendParameters(std::string& text, const ParameterValues& stated) {
  AuthoredParameters typed(stated);
  const Json all = parametersJson(typed);
  std::string_view separator;
  for (const auto& [name, value] : all.items()) {
    if (!stated.contains(name)) continue;
    text += fmt::format("{}\"{}\": {}", separator, name, compactJson(value));
    separator = ", ";
  }
}

/// Which layers collide and which are triggers, unless all collide and none is.
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
  requireSound(scene);
  constexpr std::size_t kUsualBody = 100;
  std::string text;
  text.reserve(kUsualBody * scene.bodies.size());
  text += fmt::format("{{\n\"schema\": \"{}\",\n\"name\": {},\n\"world\": {{", kAuthoredSceneSchema,
                      compactJson(scene.name));
  append(text, "min", std::span(scene.world.min).first(3));
  text += ", ";
  append(text, "max", std::span(scene.world.max).first(3));
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
