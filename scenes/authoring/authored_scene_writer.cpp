// Authored scenes to JSON, straight from the bodies: scenes may have millions of them. O(length).

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <bit>
#include <cmath>
#include <iterator>
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

using Text = fmt::memory_buffer;

/// The shortest text that reads back as the same float, with the sign of zero.
void append(Text& text, float value) {
  if (value == 0 && std::signbit(value)) {
    fmt::format_to(std::back_inserter(text), "-0.0");
  } else {
    fmt::format_to(std::back_inserter(text), "{}", value);
  }
}

void append(Text& text, std::string_view key, std::span<const float> values) {
  fmt::format_to(std::back_inserter(text), "\"{}\": [", key);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text.append(std::string_view(", "));
    append(text, values[i]);
  }
  text.push_back(']');
}

/// The same, but nothing when the values are the default bit for bit.
template <std::size_t count>
void appendUnless(const std::array<float, count>& standard, Text& text, std::string_view key,
                  const std::array<float, count>& values) {
  using Bits = std::array<std::uint32_t, count>;
  if (std::bit_cast<Bits>(values) == std::bit_cast<Bits>(standard)) return;
  text.append(std::string_view(", "));
  append(text, key, values);
}

void append(Text& text, const AuthoredBody& body) {
  const AuthoredBody standard;
  text.push_back('{');
  if (const auto* sphere = std::get_if<SphereShape>(&body.shape)) {
    text.append(std::string_view("\"sphere\": "));
    append(text, sphere->radius);
  } else {
    append(text, "box", edgesOf(body.shape));
  }
  text.append(std::string_view(", "));
  append(text, "position", body.pose.position);
  appendUnless(standard.pose.rotation, text, "rotation", body.pose.rotation);
  appendUnless(standard.linear_velocity, text, "velocity", body.linear_velocity);
  appendUnless(standard.angular_velocity, text, "angular_velocity", body.angular_velocity);
  if (body.mass != standard.mass) {
    fmt::format_to(std::back_inserter(text), ", \"mass\": {}", body.mass);
  }
  if (body.frozen) text.append(std::string_view(", \"frozen\": true"));
  const auto append_unless = [&](unsigned usual, std::string_view key, unsigned value) {
    if (value == usual) return;
    fmt::format_to(std::back_inserter(text), ", \"{}\": {}", key, value);
  };
  append_unless(standard.layer, "layer", body.layer);
  append_unless(standard.appears, "appears", body.appears);
  append_unless(standard.vanishes, "vanishes", body.vanishes);
  text.push_back('}');
}

/// The stated parameters on one line, numbers as numbers.
void appendParameters(Text& text, const ParameterValues& stated) {
  AuthoredParameters typed(stated);
  const Json all = parametersJson(typed);
  std::string_view separator;
  for (const auto& [name, value] : all.items()) {
    if (!stated.contains(name)) continue;
    fmt::format_to(std::back_inserter(text), "{}\"{}\": {}", separator, name, value.dump());
    separator = ", ";
  }
}

/// Which layers collide and which are triggers, unless all collide and none is.
void appendLayers(Text& text, const AuthoredScene& scene) {
  std::vector<std::string> pairs;
  std::vector<std::size_t> triggers;
  for (std::size_t a = 0; a < LayerMatrix::kLayers; ++a) {
    if ((scene.triggers >> a & 1) != 0) triggers.push_back(a);
    for (std::size_t b = a; b < LayerMatrix::kLayers; ++b) {
      if (scene.collide.collide(a, b)) pairs.push_back(fmt::format("[{}, {}]", a, b));
    }
  }
  const auto out = std::back_inserter(text);
  if (scene.collide != LayerMatrix::all()) {
    fmt::format_to(out, ",\n\"collide\": [{}]", fmt::join(pairs, ", "));
  }
  if (!triggers.empty()) fmt::format_to(out, ",\n\"triggers\": [{}]", fmt::join(triggers, ", "));
}

}  // namespace

std::string formatAuthoredScene(const AuthoredScene& scene) {
  requireSound(scene);
  constexpr std::size_t kUsualBody = 100;
  Text text;
  text.reserve(kUsualBody * scene.bodies.size());
  fmt::format_to(std::back_inserter(text), "{{\n\"schema\": \"{}\",\n\"name\": {},\n\"world\": {{",
                 kAuthoredSceneSchema, Json(scene.name).dump());
  append(text, "min", std::span(scene.world.min).first(3));
  text.append(std::string_view(", "));
  append(text, "max", std::span(scene.world.max).first(3));
  text.append(std::string_view("},\n\"parameters\": {"));
  appendParameters(text, scene.parameters);
  text.push_back('}');
  appendLayers(text, scene);
  text.append(std::string_view(",\n\"bodies\": ["));
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    text.append(std::string_view(i == 0 ? "\n" : ",\n"));
    append(text, scene.bodies[i]);
  }
  text.append(std::string_view("\n]\n}\n"));
  return fmt::to_string(text);
}

}  // namespace broadmark::scenes
