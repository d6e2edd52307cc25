// Authored scenes as JSON. Scenes may have millions of bodies: a text is read event by event, with
// no tree of it in memory, and written straight from the bodies, O(length) both ways.

#include "broadmark/scenes/authored_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <iterator>
#include <span>

#include "broadmark/json_fields.h"
#include "broadmark/scenes/authored_simulation.h"
#include "broadmark/scenes/registry.h"
#include "scene_parameters.h"

namespace broadmark::scenes {
namespace {

constexpr float kMostCoordinate = 1e9F;
constexpr float kMostSpeed = 1e6F;
constexpr double kLeastMass = 1e-6;
constexpr double kMostMass = 1e9;
constexpr float kRotationTolerance = 1e-3F;  ///< of the squared length
constexpr std::size_t kLongestName = 127;
/// More than there are parameters: a text with more is wrong, whatever it says.
constexpr std::size_t kMostParameters = 1000;

// ---- What is right

bool isWithin(std::span<const float> values, float limit) {
  // A comparison with NaN is false.
  return std::ranges::all_of(values, [&](float value) { return std::abs(value) <= limit; });
}

/// Of a box its edges, of a sphere its diameter.
Vec3 edgesOf(const Shape& shape) {
  const auto edges = [](const auto& kind) -> Vec3 {
    if constexpr (std::is_same_v<std::decay_t<decltype(kind)>, BoxShape>) {
      const auto& [x, y, z] = kind.half_extents;
      return {2 * x, 2 * y, 2 * z};
    } else {
      return {2 * kind.radius, 2 * kind.radius, 2 * kind.radius};
    }
  };
  return std::visit(edges, shape);
}

bool isSize(float edge) { return edge >= kLeastEdge && edge <= kMostEdge; }

std::string outOfRange(std::string_view key, double most) {
  return fmt::format("{}: numbers from {:g} to {:g} are expected", key, -most, most);
}

}  // namespace

std::string faultOfBody(const AuthoredBody& body) {
  if (!std::ranges::all_of(edgesOf(body.shape), isSize)) {
    return fmt::format("size: edges or a diameter from {:g} to {:g} are expected", kLeastEdge,
                       kMostEdge);
  }
  if (!isWithin(body.pose.position, kMostCoordinate)) {
    return outOfRange("position", kMostCoordinate);
  }
  float length = 0;
  for (const float part : body.pose.rotation) length += part * part;
  if (!(std::abs(length - 1) <= kRotationTolerance)) {
    return "rotation: a quaternion x, y, z, w of unit length is expected";
  }
  if (!(body.mass >= kLeastMass && body.mass <= kMostMass)) {
    return fmt::format("mass: a number from {:g} to {:g} is expected", kLeastMass, kMostMass);
  }
  if (!isWithin(body.linear_velocity, kMostSpeed)) return outOfRange("velocity", kMostSpeed);
  if (!isWithin(body.angular_velocity, kMostSpeed)) {
    return outOfRange("angular_velocity", kMostSpeed);
  }
  return {};
}

std::string faultOfName(std::string_view name) {
  const bool printable =
      std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~' && c != '/'; });
  if (printable && !name.empty() && name.size() <= kLongestName) return {};
  return fmt::format(
      "name: 1 to {} printable ASCII characters are expected, none of them '/': it becomes part of "
      "file names",
      kLongestName);
}

std::string faultOfWorld(const Aabb& world) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool right = std::abs(world.min[axis]) <= kMostCoordinate &&
                       std::abs(world.max[axis]) <= kMostCoordinate &&
                       world.min[axis] < world.max[axis];
    if (right) continue;
    return fmt::format("world: min below max is expected on every axis, from {:g} to {:g}",
                       -kMostCoordinate, kMostCoordinate);
  }
  return {};
}

namespace {

void requireRight(const std::string& fault, std::string_view where) {
  if (!fault.empty()) throw InputError(fmt::format("{}: {}", where, fault));
}

// ---- Writing

using Text = fmt::memory_buffer;

/// The shortest text that reads back as the same float, the sign of zero included.
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

/// The same unless the values are, bit for bit, the default.
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
  text.push_back('}');
}

/// The stated parameters, with the types that they have, on one line.
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

// ---- Reading

/// What a key of a body is, and how many numbers it takes; 0: it takes something else.
struct BodyKey {
  std::string_view name;
  std::size_t numbers;
};
constexpr std::array<BodyKey, 8> kBodyKeys = {{{"box", 3},
                                               {"sphere", 0},
                                               {"position", 3},
                                               {"rotation", 4},
                                               {"velocity", 3},
                                               {"angular_velocity", 3},
                                               {"mass", 0},
                                               {"frozen", 0}}};

template <class Keys>
std::vector<std::string> namesOf(const Keys& keys) {
  std::vector<std::string> names;
  for (const auto& key : keys) names.emplace_back(key.name);
  return names;
}

/// Puts a scene together from what is read.
class SceneReader final : public JsonEvents {
 public:
  using JsonEvents::JsonEvents;

  /// The scene, once all is read.
  AuthoredScene finish() {
    if (schema_ != kAuthoredSceneSchema) {
      fail(fmt::format("schema: {} is expected", kAuthoredSceneSchema));
    }
    for (const char* key : {"name", "world", "bodies"}) {
      if (!stated(key)) fail(fmt::format("'{}' is missing", key));
    }
    requireRight(faultOfName(scene_.name), name());
    requireRight(faultOfWorld(scene_.world), name());
    setParameters();
    return std::move(scene_);
  }

  bool null() override { return refuse(); }

  bool boolean(bool value) override {
    if (in_ == In::body && key_ == "frozen") {
      body_.frozen = value;
    } else if (in_ == In::parameters) {
      addParameter(value);
    } else {
      refuse();
    }
    return true;
  }

  bool number_integer(number_integer_t value) override {
    if (in_ == In::parameters) return addParameter(value);
    return number(static_cast<float>(value), static_cast<double>(value));
  }

  bool number_unsigned(number_unsigned_t value) override {
    if (in_ == In::parameters) return addParameter(value);
    return number(static_cast<float>(value), static_cast<double>(value));
  }

  bool number_float(number_float_t value, const string_t& text) override {
    if (in_ == In::parameters) return addParameter(value);
    // From the text itself: rounding twice, by way of a double, might end at a neighbour.
    auto nearest = static_cast<float>(value);
    std::from_chars(text.data(), text.data() + text.size(), nearest);
    return number(nearest, value);
  }

  bool string(string_t& value) override {
    if (in_ == In::scene && key_ == "schema") {
      schema_ = value;
      if (schema_ != kAuthoredSceneSchema) {
        fail(fmt::format("schema: '{}' is not {}", onOneLine(schema_), kAuthoredSceneSchema));
      }
    } else if (in_ == In::scene && key_ == "name") {
      scene_.name = value;
    } else if (in_ == In::parameters) {
      addParameter(value);
    } else {
      refuse();
    }
    return true;
  }

  bool start_object(std::size_t) override {
    if (in_ == In::nothing) {
      in_ = In::scene;
    } else if (in_ == In::scene && key_ == "world") {
      in_ = In::world;
    } else if (in_ == In::scene && key_ == "parameters") {
      in_ = In::parameters;
    } else if (in_ == In::bodies) {
      if (scene_.bodies.size() == kMostAuthoredBodies) {
        fail(fmt::format("bodies: more than {}", kMostAuthoredBodies));
      }
      in_ = In::body;
      body_ = {};
      body_keys_ = 0;
    } else {
      refuse();
    }
    return true;
  }

  bool key(string_t& key) override {
    switch (in_) {
      case In::scene:
        if (stated(key)) fail(fmt::format("'{}' is stated twice", onOneLine(key)));
        require(key, {"schema", "name", "world", "parameters", "bodies"});
        scene_keys_.push_back(key);
        break;
      case In::world:
        require(key, {"min", "max"});
        break;
      case In::body:
        addBodyKey(key);
        break;
      default:
        break;
    }
    key_ = std::move(key);
    return true;
  }

  bool end_object() override {
    if (in_ == In::body) {
      endBody();
    } else if (in_ == In::world && (world_keys_ != 3)) {
      fail("world: 'min' and 'max' are expected");
    }
    in_ = in_ == In::body ? In::bodies : in_ == In::scene ? In::nothing : In::scene;
    return true;
  }

  bool start_array(std::size_t) override {
    if (in_ == In::scene && key_ == "bodies") {
      in_ = In::bodies;
    } else if (const std::size_t wanted = numbersOf(key_); wanted > 0) {
      around_ = in_;
      in_ = In::numbers;
      wanted_ = wanted;
      read_ = 0;
    } else {
      refuse();
    }
    return true;
  }

  bool end_array() override {
    if (in_ == In::bodies) {
      in_ = In::scene;
      return true;
    }
    if (read_ != wanted_) refuse();
    in_ = around_;
    keepNumbers();
    return true;
  }

 private:
  enum class In { nothing, scene, world, parameters, bodies, body, numbers };

  [[nodiscard]] bool stated(std::string_view key) const {
    return std::ranges::find(scene_keys_, key) != scene_keys_.end();
  }

  /// Where the reading is, for messages.
  [[nodiscard]] std::string place() const {
    const In in = in_ == In::numbers ? around_ : in_;
    if (in == In::body) return fmt::format("{}: body {}", name(), scene_.bodies.size());
    return in == In::world ? name() + ": world" : name();
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", place(), what));
  }

  /// A value of the wrong kind.
  bool refuse() const {
    if (in_ == In::nothing) fail("a JSON object is expected");
    if (in_ == In::bodies) fail("bodies: an array of objects is expected");
    const In in = in_ == In::numbers ? around_ : in_;
    std::string_view wanted = "a text";
    if (in == In::parameters) {
      wanted = "a number, a text, true or false";
    } else if (numbersOf(key_) == 3) {
      wanted = "an array of three numbers";
    } else if (numbersOf(key_) == 4) {
      wanted = "an array of four numbers";
    } else if (in == In::body) {
      wanted = key_ == "frozen" ? "true or false" : "a number";
    } else if (key_ == "world" || key_ == "parameters") {
      wanted = "an object";
    } else if (key_ == "bodies") {
      wanted = "an array of objects";
    }
    fail(fmt::format("{}: {} is expected", onOneLine(key_), wanted));
  }

  void require(const std::string& key, const std::vector<std::string>& known) const {
    if (std::ranges::find(known, key) == known.end()) {
      fail(unknownName("key", onOneLine(key), known));
    }
  }

  /// How many numbers the array under a key holds; 0: it is none.
  [[nodiscard]] std::size_t numbersOf(const std::string& key) const {
    const In in = in_ == In::numbers ? around_ : in_;
    if (in == In::world) return 3;
    if (in != In::body) return 0;
    const auto found = std::ranges::find(kBodyKeys, key, &BodyKey::name);
    return found == kBodyKeys.end() ? 0 : found->numbers;
  }

  void addBodyKey(const std::string& key) {
    const auto found = std::ranges::find(kBodyKeys, key, &BodyKey::name);
    if (found == kBodyKeys.end()) {
      fail(unknownName("key", onOneLine(key), namesOf(kBodyKeys)));
    }
    const auto bit = 1U << static_cast<unsigned>(found - kBodyKeys.begin());
    if ((body_keys_ & bit) != 0) fail(fmt::format("'{}' is stated twice", key));
    body_keys_ |= bit;
  }

  [[nodiscard]] bool bodyStates(std::string_view key) const {
    const auto found = std::ranges::find(kBodyKeys, key, &BodyKey::name);
    return (body_keys_ >> static_cast<unsigned>(found - kBodyKeys.begin()) & 1U) != 0;
  }

  bool number(float value, double exact) {
    if (in_ == In::numbers) {
      if (read_ == wanted_) refuse();
      numbers_[read_++] = value;
    } else if (in_ == In::body && key_ == "sphere") {
      body_.shape = SphereShape{value};
    } else if (in_ == In::body && key_ == "mass") {
      body_.mass = exact;
    } else {
      refuse();
    }
    return true;
  }

  /// The array just read goes where its key says.
  void keepNumbers() {
    const Vec3 vector = {numbers_[0], numbers_[1], numbers_[2]};
    if (in_ == In::world) {
      world_keys_ |= key_ == "min" ? 1U : 2U;
      auto& corner = key_ == "min" ? scene_.world.min : scene_.world.max;
      std::ranges::copy(vector, corner.begin());
    } else if (key_ == "box") {
      body_.shape = BoxShape{{vector[0] / 2, vector[1] / 2, vector[2] / 2}};
    } else if (key_ == "position") {
      body_.pose.position = vector;
    } else if (key_ == "rotation") {
      body_.pose.rotation = numbers_;
    } else if (key_ == "velocity") {
      body_.linear_velocity = vector;
    } else {
      body_.angular_velocity = vector;
    }
  }

  void endBody() {
    if (bodyStates("box") == bodyStates("sphere")) fail("either 'box' or 'sphere' is expected");
    if (!bodyStates("position")) fail("'position' is missing");
    requireRight(faultOfBody(body_), place());
    scene_.bodies.push_back(body_);
  }

  template <class Value>
  bool addParameter(const Value& value) {
    if (parameters_.size() == kMostParameters) {
      fail(fmt::format("parameters: more than {}", kMostParameters));
    }
    parameters_[key_] = value;
    return true;
  }

  /// Checks the parameters and keeps them as text that no longer depends on how they were written.
  void setParameters() {
    AuthoredParameters typed;
    try {
      setParametersFromJson(typed, parameters_);
    } catch (const InputError& error) {
      fail(error.what());
    }
    for (const auto& [key, value] : typed.values()) {
      if (parameters_.contains(key)) scene_.parameters[key] = value;
    }
  }

  AuthoredScene scene_;
  std::string schema_;
  Json parameters_ = Json::object();
  std::vector<std::string> scene_keys_;
  unsigned world_keys_ = 0;  ///< bit 0: min, bit 1: max
  AuthoredBody body_;        ///< the one being read
  unsigned body_keys_ = 0;   ///< its keys so far, a bit each
  In in_ = In::nothing;
  In around_ = In::nothing;  ///< the array of numbers that is being read
  std::string key_;          ///< the last one
  Quaternion numbers_{};
  std::size_t wanted_ = 0;
  std::size_t read_ = 0;
};

}  // namespace

std::string formatAuthoredScene(const AuthoredScene& scene) {
  requireRight(faultOfName(scene.name), "authored scene");
  requireRight(faultOfWorld(scene.world), "authored scene");
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
  text.append(std::string_view("},\n\"bodies\": ["));
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const std::string fault = faultOfBody(scene.bodies[i]);
    if (!fault.empty()) requireRight(fault, fmt::format("authored scene: body {}", i));
    text.append(std::string_view(i == 0 ? "\n" : ",\n"));
    append(text, scene.bodies[i]);
  }
  text.append(std::string_view("\n]\n}\n"));
  return fmt::to_string(text);
}

AuthoredScene parseAuthoredScene(std::string_view json, std::string_view name) {
  SceneReader reader(name);
  Json::sax_parse(json, &reader);
  return reader.finish();
}

std::string objectTypeName(const AuthoredScene& scene) {
  const auto every = [&](auto&& holds) {
    return std::ranges::all_of(scene.bodies,
                               [&](const AuthoredBody& body) { return holds(body.shape); });
  };
  const bool spheres = every([](const Shape& s) { return std::holds_alternative<SphereShape>(s); });
  const bool cubes = every([](const Shape& s) {
    const Vec3 edges = edgesOf(s);
    return std::holds_alternative<BoxShape>(s) && edges[0] == edges[1] && edges[1] == edges[2];
  });
  const std::string id = cubes ? "cubes" : spheres ? "spheres" : "assorted";
  return entryOf(objectTypes(), {id, {}}, "object type").listing.name;
}

std::vector<Aabb> boxesOf(const AuthoredScene& scene) {
  std::vector<Aabb> boxes(scene.bodies.size());
  std::ranges::transform(scene.bodies, boxes.begin(),
                         [](const AuthoredBody& body) { return tightBox(body.shape, body.pose); });
  return boxes;
}

}  // namespace broadmark::scenes
