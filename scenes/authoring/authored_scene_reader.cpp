// Authored scenes from JSON. Scenes may have millions of bodies: each one is converted and freed as
// soon as it has been read, so the JSON of all bodies is never in memory. O(length).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <type_traits>

#include "authoring/faults.h"
#include "broadmark/error.h"
#include "broadmark/json_fields.h"
#include "broadmark/names.h"
#include "broadmark/scenes/authored_scene.h"
#include "broadmark/scenes/authored_simulation.h"
#include "broadmark/scenes/simulation.h"
#include "scene_parameters.h"

namespace broadmark::scenes {
namespace {

// Maximum size of objects and arrays except the bodies: bounds the memory for invalid input.
constexpr std::size_t kMaxElements = 2000;
constexpr std::size_t kMaxDepth = 6;

// Each function converts a value; on failure returns a description of the expected value.

const char* convert(const Json& json, std::string& value) {
  if (!json.is_string()) return "a string";
  value = json.get<std::string>();
  return nullptr;
}

const char* convert(const Json& json, bool& value) {
  if (!json.is_boolean()) return "true or false";
  value = json.get<bool>();
  return nullptr;
}

template <std::floating_point Number>
const char* convert(const Json& json, Number& value) {
  if (!json.is_number()) return "a number";
  value = json.get<Number>();
  return nullptr;
}

/// Replaces non-integers and numbers that are too large by a number that is invalid everywhere.
template <std::unsigned_integral Number>
const char* convert(const Json& json, Number& value) {
  constexpr Number kFault = std::numeric_limits<Number>::max() - 1;
  if (!json.is_number()) return "a number";
  const auto number = json.get<double>();
  const bool is_valid = number >= 0 && number < kFault && number == std::floor(number);
  value = is_valid ? static_cast<Number>(number) : kFault;
  return nullptr;
}

template <class Number, std::size_t count>
const char* convert(const Json& json, std::array<Number, count>& values) {
  bool is_valid = json.is_array() && json.size() == count;
  for (std::size_t i = 0; is_valid && i < count; ++i)
    is_valid = convert(json[i], values[i]) == nullptr;
  if (is_valid) return nullptr;
  return count == 4 ? "an array of four numbers" : "an array of three numbers";
}

/// For layers, or pairs of layers.
template <class Layers>
const char* convert(const Json& json, std::vector<Layers>& values) {
  const auto is_valid = [&](const Json& element) {
    return convert(element, values.emplace_back()) == nullptr;
  };
  if (json.is_array() && std::ranges::all_of(json, is_valid)) return nullptr;
  return std::is_integral_v<Layers> ? "an array of layers"
                                    : "an array of pairs of layers, each [a, b],";
}

/// Builds the scene during parsing.
class SceneReader final : public JsonEvents {
 public:
  using JsonEvents::JsonEvents;

  /// Returns the scene, once the whole text has been read.
  AuthoredScene finish() {
    section_ = Section::other;
    std::string schema;
    require(root_, {"schema", "name", "world", "parameters", "collide", "triggers", "bodies"});
    if (!read(root_, "schema", schema)) expected("schema", kAuthoredSceneSchema);
    if (schema != kAuthoredSceneSchema) {
      fail(fmt::format("schema: '{}' is not {}", onOneLine(schema), kAuthoredSceneSchema));
    }
    read(root_, "name", scene_.name);
    readWorld();
    readLayers();
    for (const char* key : {"name", "world", "bodies"}) {
      if (!root_.contains(key)) fail(fmt::format("'{}' is missing", key));
    }
    requireNoFault(faultOfName(scene_.name));
    requireNoFault(faultOfWorld(scene_.world));
    readParameters();
    return std::move(scene_);
  }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }

  bool number_float(number_float_t value, const string_t& text) override {
    // Directly from text to float: rounding to double first could yield a neighbouring float.
    auto nearest = static_cast<float>(value);
    std::from_chars(text.data(), text.data() + text.size(), nearest);
    const bool is_float = !open_.empty() && (open_.back()->is_array() || key_ == "sphere");
    return add(is_float && static_cast<float>(value) != nearest ? double{nearest} : value);
  }

  bool key(string_t& key) override {
    const Json& object = *open_.back();
    if (open_.size() == 1) section_ = Section::other;
    if (object.contains(key)) fail(fmt::format("'{}' is stated twice", onOneLine(key)));
    if (open_.size() == 1) {
      section_ = key == "bodies"  ? Section::bodies
                 : key == "world" ? Section::world
                                  : Section::other;
    }
    key_ = std::move(key);
    return true;
  }

  bool start_object(std::size_t) override {
    open_.push_back(&insert(Json::object()));
    return true;
  }

  bool start_array(std::size_t) override {
    open_.push_back(&insert(Json::array()));
    return true;
  }

  bool end_object() override {
    if (open_.size() == 3 && section_ == Section::bodies) readBody(*open_.back());
    open_.pop_back();
    return true;
  }

  bool end_array() override {
    open_.pop_back();
    return true;
  }

 private:
  enum class Section { other, world, bodies };

  [[noreturn]] void fail(const std::string& what) const {
    std::string location = name();
    if (section_ == Section::world) location += ": world";
    if (section_ == Section::bodies && open_.size() > 2) {
      location += fmt::format(": body {}", scene_.bodies.size());
    }
    throw InputError(fmt::format("{}: {}", location, what));
  }

  [[noreturn]] void expected(std::string_view key, std::string_view expected_value) const {
    fail(fmt::format("{}: {} is expected", key, expected_value));
  }

  void requireNoFault(const std::string& fault) const {
    if (!fault.empty()) fail(fault);
  }

  void require(const Json& object, const std::vector<std::string>& keys) const {
    for (const auto& item : object.items()) {
      if (std::ranges::find(keys, item.key()) != keys.end()) continue;
      fail(unknownName("key", onOneLine(item.key()), keys));
    }
  }

  /// Adds a value to the current container.
  Json& insert(Json value) {
    if (open_.empty()) {
      if (!value.is_object()) fail("a JSON object is expected");
      return root_ = std::move(value);
    }
    const bool is_bodies = section_ == Section::bodies && open_.size() == 1;
    const bool is_body = section_ == Section::bodies && open_.size() == 2;
    if ((is_bodies && !value.is_array()) || (is_body && !value.is_object())) {
      expected("bodies", "an array of objects");
    }
    Json& container = *open_.back();
    if (container.size() == kMaxElements) fail(fmt::format("{}: too many values", onOneLine(key_)));
    if (open_.size() == kMaxDepth) fail(fmt::format("{}: nested too deeply", onOneLine(key_)));
    if (is_body && !container.empty()) {
      container[0].clear();  // the previous body, to reuse its memory
      return container[0];
    }
    if (container.is_object()) return container[key_] = std::move(value);
    container.push_back(std::move(value));
    return container.back();
  }

  bool add(Json value) {
    insert(std::move(value));
    return true;
  }

  /// Converts a value; returns false if it is missing.
  template <class Value>
  bool read(const Json& object, const char* key, Value& value) const {
    const auto found = object.find(key);
    if (found == object.end()) return false;
    if (const char* expected_value = convert(*found, value)) expected(key, expected_value);
    return true;
  }

  void readBody(const Json& json) {
    if (scene_.bodies.size() == kMaxBodies) fail(fmt::format("more than {}", kMaxBodies));
    AuthoredBody body;
    Vec3 edges;
    float radius = 0;
    const bool is_box = read(json, "box", edges);
    const bool is_sphere = read(json, "sphere", radius);
    std::size_t read_count = std::size_t{is_box} + std::size_t{is_sphere};
    visitProperties(body, [&](const char* key, auto& value, const auto& /*default*/) {
      read_count += std::size_t{read(json, key, value)};
    });
    if (read_count < json.size()) {
      std::vector<std::string> keys = {"box", "sphere"};
      visitProperties(body, [&](const char* key, auto&, auto&) { keys.emplace_back(key); });
      require(json, keys);
    }
    if (is_box == is_sphere) fail("either 'box' or 'sphere' is expected");
    if (!json.contains("position")) fail("'position' is missing");
    if (is_sphere) {
      body.shape = SphereShape{radius};
    } else {
      body.shape = BoxShape{{edges[0] / 2, edges[1] / 2, edges[2] / 2}};
    }
    requireNoFault(faultOfBody(body));
    scene_.bodies.push_back(body);
  }

  void readWorld() {
    if (!root_.contains("world")) return;
    const Json& world = root_["world"];
    if (!world.is_object()) expected("world", "an object");
    section_ = Section::world;
    require(world, {"min", "max"});
    Vec3 min;
    Vec3 max;
    if (!read(world, "min", min) || !read(world, "max", max)) {
      fail("'min' and 'max' are expected");
    }
    section_ = Section::other;
    scene_.world = {{min[0], min[1], min[2], 0}, {max[0], max[1], max[2], 0}};
  }

  void readLayers() {
    const auto require_layer = [this](const char* key, std::uint8_t layer) {
      if (layer >= LayerMatrix::kLayers) fail(faultOfLayer(key));
    };
    std::vector<std::array<std::uint8_t, 2>> pairs;
    if (read(root_, "collide", pairs)) scene_.collide = {};
    for (const auto& [a, b] : pairs) {
      require_layer("collide", std::max(a, b));
      scene_.collide.set(a, b);
    }
    std::vector<std::uint8_t> triggers;
    read(root_, "triggers", triggers);
    for (const std::uint8_t layer : triggers) {
      require_layer("triggers", layer);
      scene_.triggers |= std::uint32_t{1} << layer;
    }
  }

  /// Validates the parameters and stores them as normalised text.
  void readParameters() {
    if (!root_.contains("parameters")) return;
    const Json& stated = root_["parameters"];
    if (!stated.is_object()) expected("parameters", "an object");
    AuthoredParameters typed;
    try {
      setParametersFromJson(typed, stated);
    } catch (const InputError& error) {
      fail(error.what());
    }
    for (const auto& [key, value] : typed.values()) {
      if (stated.contains(key)) scene_.parameters[key] = value;
    }
  }

  AuthoredScene scene_;
  Json root_;                         ///< without bodies already read
  std::vector<Json*> open_;           ///< open objects and arrays, each nested in the previous
  Section section_ = Section::other;  ///< of the scene
  std::string key_;                   ///< the last key
};

}  // namespace

AuthoredScene parseAuthoredScene(std::string_view json, std::string_view name) {
  SceneReader reader(name);
  readJson(json, reader);
  return reader.finish();
}

}  // namespace broadmark::scenes
