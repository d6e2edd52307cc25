// Authored scenes from JSON. Scenes may have millions of bodies: the text is read event by event,
// without a tree of it in memory. O(length).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

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

/// Far more than there are: keeps the memory for unknown ones small.
constexpr std::size_t kMostParameters = 1000;

/// A key of a body.
struct BodyKey {
  std::string_view name;
  std::size_t numbers;  ///< length of its array of numbers; 0: its value is not an array
};
constexpr std::array<BodyKey, 12> kBodyKeys = {{{"box", 3},
                                                {"sphere", 0},
                                                {"position", 3},
                                                {"rotation", 4},
                                                {"velocity", 3},
                                                {"angular_velocity", 3},
                                                {"mass", 0},
                                                {"frozen", 0},
                                                {"layer", 0},
                                                {"appears", 0},
                                                {"vanishes", 0},
                                                {"group", 0}}};

std::vector<std::string> namesOfBodyKeys() {
  std::vector<std::string> names;
  for (const BodyKey& key : kBodyKeys) names.emplace_back(key.name);
  return names;
}

/// Its place in kBodyKeys; their number if the name is unknown.
std::size_t indexOfBodyKey(std::string_view name) {
  const auto found = std::ranges::find(kBodyKeys, name, &BodyKey::name);
  return static_cast<std::size_t>(found - kBodyKeys.begin());
}

/// Builds the scene as the text is read.
class SceneReader final : public JsonEvents {
 public:
  using JsonEvents::JsonEvents;

  /// The scene, after the whole text has been read.
  AuthoredScene finish() {
    if (schema_ != kAuthoredSceneSchema) {
      fail(fmt::format("schema: {} is expected", kAuthoredSceneSchema));
    }
    for (const char* key : {"name", "world", "bodies"}) {
      if (!stated(key)) fail(fmt::format("'{}' is missing", key));
    }
    requireNoFault(faultOfName(scene_.name));
    requireNoFault(faultOfWorld(scene_.world));
    setParameters();
    return std::move(scene_);
  }

  bool null() override { return refuse(); }

  bool boolean(bool value) override {
    if (in_ == In::parameters) return addParameter(value);
    if (in_ != In::body || key_ != "frozen") return refuse();
    body_.frozen = value;
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
    // From the text: rounding to a double first could give a neighbouring float.
    auto nearest = static_cast<float>(value);
    std::from_chars(text.data(), text.data() + text.size(), nearest);
    return number(nearest, value);
  }

  bool string(string_t& value) override {
    if (in_ == In::parameters) return addParameter(value);
    if (in_ == In::scene && key_ == "schema") return setSchema(value);
    if (in_ != In::scene || key_ != "name") return refuse();
    scene_.name = value;
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
      if (scene_.bodies.size() == kMostBodies) {
        fail(fmt::format("bodies: more than {}", kMostBodies));
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
        require(key, {"schema", "name", "world", "parameters", "collide", "triggers", "bodies"});
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
    } else if (in_ == In::world && world_keys_ != 3) {
      fail("world: 'min' and 'max' are expected");
    }
    in_ = in_ == In::body ? In::bodies : in_ == In::scene ? In::nothing : In::scene;
    return true;
  }

  bool start_array(std::size_t) override {
    if (in_ == In::scene && key_ == "bodies") {
      in_ = In::bodies;
    } else if (in_ == In::scene && key_ == "collide") {
      in_ = In::collide;
      scene_.collide = {};
    } else if (in_ == In::scene && key_ == "triggers") {
      in_ = In::triggers;
    } else if (const std::size_t wanted = numbersOf(key_); in_ != In::numbers && wanted > 0) {
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
    if (in_ != In::numbers) {
      in_ = In::scene;
      return true;
    }
    if (read_ != wanted_) refuse();
    in_ = around_;
    keepNumbers();
    return true;
  }

 private:
  enum class In { nothing, scene, world, parameters, collide, triggers, bodies, body, numbers };

  [[nodiscard]] bool stated(std::string_view key) const {
    return std::ranges::find(scene_keys_, key) != scene_keys_.end();
  }

  /// The object that is being read.
  [[nodiscard]] In object() const { return in_ == In::numbers ? around_ : in_; }

  /// Where in the text a fault is, for messages.
  [[nodiscard]] std::string place() const {
    const In in = object();
    if (in == In::body) return fmt::format("{}: body {}", name(), scene_.bodies.size());
    return in == In::world ? name() + ": world" : name();
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", place(), what));
  }

  void requireNoFault(const std::string& fault) const {
    if (!fault.empty()) fail(fault);
  }

  bool setSchema(const std::string& schema) {
    schema_ = schema;
    if (schema == kAuthoredSceneSchema) return true;
    fail(fmt::format("schema: '{}' is not {}", onOneLine(schema), kAuthoredSceneSchema));
  }

  /// Fails because of a value of the wrong type.
  [[noreturn]] bool refuse() const {
    if (in_ == In::nothing) fail("a JSON object is expected");
    if (in_ == In::bodies) fail("bodies: an array of objects is expected");
    const In in = object();
    std::string_view wanted = "a text";
    if (in == In::parameters) {
      wanted = "a number, a text, true or false";
    } else if (numbersOf(key_) == 3) {
      wanted = "an array of three numbers";
    } else if (numbersOf(key_) == 4) {
      wanted = "an array of four numbers";
    } else if (in == In::body) {
      wanted = key_ == "frozen" ? "true or false" : "a number";
    } else if (key_ == "collide") {
      wanted = "an array of pairs of layers, each [a, b],";
    } else if (key_ == "triggers") {
      wanted = "an array of layers";
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

  /// The length of the array of numbers under a key; 0: its value is not one.
  [[nodiscard]] std::size_t numbersOf(const std::string& key) const {
    if (object() == In::world) return 3;
    if (object() == In::collide) return 2;
    if (object() != In::body) return 0;
    const std::size_t index = indexOfBodyKey(key);
    return index == kBodyKeys.size() ? 0 : kBodyKeys[index].numbers;
  }

  void addBodyKey(const std::string& key) {
    const std::size_t index = indexOfBodyKey(key);
    if (index == kBodyKeys.size()) fail(unknownName("key", onOneLine(key), namesOfBodyKeys()));
    const unsigned bit = 1U << index;
    if ((body_keys_ & bit) != 0) fail(fmt::format("'{}' is stated twice", key));
    body_keys_ |= bit;
  }

  [[nodiscard]] bool bodyStates(std::string_view key) const {
    return (body_keys_ >> indexOfBodyKey(key) & 1U) != 0;
  }

  bool number(float value, double exact) {
    if (in_ == In::numbers) {
      if (read_ == wanted_) refuse();
      if (around_ == In::collide) value = layer(exact);
      numbers_[read_++] = value;
    } else if (in_ == In::triggers) {
      scene_.triggers |= std::uint32_t{1} << layer(exact);
    } else if (in_ == In::body && key_ == "layer") {
      body_.layer = layer(exact);
    } else if (in_ == In::body && key_ == "appears") {
      body_.appears = frame(exact);
    } else if (in_ == In::body && key_ == "vanishes") {
      body_.vanishes = frame(exact);
    } else if (in_ == In::body && key_ == "group") {
      body_.group = integer(exact, kMostBodies, faultOfGroup);
    } else if (in_ == In::body && key_ == "sphere") {
      body_.shape = SphereShape{value};
    } else if (in_ == In::body && key_ == "mass") {
      body_.mass = exact;
    } else {
      refuse();
    }
    return true;
  }

  /// The number as an integer from 0 to `max`; any other has the fault that `fault` words.
  template <class Fault>
  [[nodiscard]] std::uint32_t integer(double number, std::size_t max, Fault fault) const {
    const bool right = number >= 0 && number <= static_cast<double>(max);
    if (!right || number != std::floor(number)) fail(fault());
    return static_cast<std::uint32_t>(number);
  }

  [[nodiscard]] std::uint8_t layer(double number) const {
    return static_cast<std::uint8_t>(
        integer(number, LayerMatrix::kLayers - 1, [&] { return faultOfLayer(key_); }));
  }

  [[nodiscard]] std::uint32_t frame(double number) const {
    return integer(number, kMostFrames, [&] {
      return fmt::format("{}: a frame from 0 to {} is expected", key_, kMostFrames);
    });
  }

  /// Stores the array that has just been read.
  void keepNumbers() {
    const Vec3 vector = {numbers_[0], numbers_[1], numbers_[2]};
    if (in_ == In::collide) {
      scene_.collide.set(static_cast<std::size_t>(vector[0]), static_cast<std::size_t>(vector[1]));
    } else if (in_ == In::world) {
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
    requireNoFault(faultOfBody(body_));
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

  /// Checks the parameters and keeps them as text: equal values become equal texts.
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
  AuthoredBody body_;        ///< the body that is being read
  unsigned body_keys_ = 0;   ///< its keys so far: bit i is kBodyKeys[i]
  In in_ = In::nothing;
  In around_ = In::nothing;  ///< the object with the array of numbers that is being read
  std::string key_;          ///< the last key
  Quaternion numbers_{};
  std::size_t wanted_ = 0;
  std::size_t read_ = 0;
};

}  // namespace

AuthoredScene parseAuthoredScene(std::string_view json, std::string_view name) {
  SceneReader reader(name);
  readJson(json, reader);
  return reader.finish();
}

}  // namespace broadmark::scenes
