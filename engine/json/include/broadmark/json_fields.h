// Reading JSON fields, with errors that name the file, the key and the expected value.
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/error.h"

namespace broadmark {

using Json = nlohmann::ordered_json;

/// Parses a text; `name` is used in messages. Throws InputError with line and column.
Json parseJson(std::string_view text, std::string_view name);

/// Parses a text; returns null where parseJson() would throw.
Json jsonOrNull(std::string_view text);

/// Serialises, with a final line feed; `indent` spaces a level. Replaces invalid UTF-8 (names may
/// come from file names).
std::string formatJson(const Json& json, int indent = 1);

/// Serialises on one line, without a line feed.
std::string compactJson(const Json& json);

/// The value, or null.
template <class T>
Json orNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// Escapes control characters, for messages.
std::string onOneLine(const std::string& text);

/// The schema of a JSON text: the value of its "schema" ("broadmark-results/1"), or "" if it has
/// none. Does not read the rest. Throws InputError if the text is not JSON.
std::string jsonSchema(std::string_view text, std::string_view name);
/// Whether a JSON text is an object with this key. Stops reading at the key. Throws InputError if
/// the text is not JSON.
bool jsonHasKey(std::string_view text, std::string_view key, std::string_view name);

/// SAX handler for JSON texts that should not be loaded as a whole. Ignores all events by default;
/// a method that returns false ends the reading.
class JsonEvents : public nlohmann::json_sax<Json> {
 public:
  /// `name` is used in messages.
  explicit JsonEvents(std::string_view name) : name_(name) {}

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t& /*as written*/) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t, const std::string&,
                   const nlohmann::detail::exception& error) override;

 protected:
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
};

/// Passes the events of a text to `events`, until a method returns false. Throws InputError if it
/// is not JSON.
void readJson(std::string_view text, JsonEvents& events);

/// A view of one JSON object within a file.
class JsonFields {
 public:
  JsonFields(const Json& json, std::string name) : json_(json), name_(std::move(name)) {
    if (!json_.is_object()) throw InputError(name_ + ": a JSON object is expected");
  }

  /// The object's name in messages.
  [[nodiscard]] const std::string& name() const { return name_; }

  [[nodiscard]] bool has(const char* key) const {
    return json_.contains(key) && !json_[key].is_null();
  }

  [[nodiscard]] const Json& at(const char* key) const {
    const auto field = json_.find(key);
    if (field == json_.end()) throw InputError(fmt::format("{}: '{}' is missing", name_, key));
    return *field;
  }

  [[nodiscard]] JsonFields object(const char* key) const { return {at(key), path(key)}; }

  [[nodiscard]] const Json& array(const char* key) const {
    return expect(key, at(key).is_array(), "an array");
  }

  [[nodiscard]] std::string text(const char* key) const {
    return expect(key, at(key).is_string(), "a string").template get<std::string>();
  }

  /// The value with this name in a NameTable.
  template <class Table>
  [[nodiscard]] auto named(const char* key, const Table& table) const {
    const std::string name = text(key);
    const auto value = table.find(name);
    if (!value) throw InputError(fmt::format("{}: unknown value '{}'", path(key), name));
    return *value;
  }

  [[nodiscard]] std::vector<std::string> texts(const char* key) const {
    std::vector<std::string> all;
    for (const Json& element : array(key)) {
      if (!element.is_string()) throw InputError(path(key) + ": strings are expected");
      all.push_back(element.get<std::string>());
    }
    return all;
  }

  [[nodiscard]] bool boolean(const char* key) const {
    return expect(key, at(key).is_boolean(), "true or false").template get<bool>();
  }

  [[nodiscard]] double number(const char* key) const {
    return expect(key, at(key).is_number(), "a number").template get<double>();
  }

  /// An integer within the range of `Integer`, or from `min` on.
  template <class Integer>
  [[nodiscard]] Integer integer(const char* key,
                                Integer min = std::numeric_limits<Integer>::min()) const {
    return integerOf<Integer>(at(key), path(key), min);
  }

  /// Reads a field of the type of `value`; integers must not be negative. An optional field may be
  /// missing; a map has a field per element.
  void read(const char* key, std::string& value) const { value = text(key); }
  void read(const char* key, std::vector<std::string>& value) const { value = texts(key); }
  void read(const char* key, bool& value) const { value = boolean(key); }
  void read(const char* key, double& value) const { value = number(key); }
  template <std::integral Integer>
  void read(const char* key, Integer& value) const {
    value = integer<Integer>(key, 0);
  }
  template <class T>
  void read(const char* key, std::optional<T>& value) const {
    if (has(key)) read(key, value.emplace());
  }
  template <class T>
  void read(const char* key, std::map<std::string, T>& values) const {
    const JsonFields fields = object(key);
    for (const auto& item : at(key).items()) fields.read(item.key().c_str(), values[item.key()]);
  }

  /// The elements of an array, each as an object.
  template <class Visit>
  void eachObject(const char* key, Visit&& visit) const {
    const Json& elements = array(key);
    for (std::size_t i = 0; i < elements.size(); ++i) {
      visit(JsonFields(elements[i], fmt::format("{}[{}]", path(key), i)));
    }
  }

  [[nodiscard]] std::string path(const char* key) const {
    return fmt::format("{}: {}", name_, key);
  }

  template <class Integer>
  static Integer integerOf(const Json& value, const std::string& name,
                           Integer min = std::numeric_limits<Integer>::min()) {
    constexpr auto kMax = std::numeric_limits<Integer>::max();
    bool is_valid = false;
    if (value.is_number_unsigned()) {
      const auto number = value.get<std::uint64_t>();
      is_valid = std::cmp_less_equal(number, kMax) && std::cmp_greater_equal(number, min);
    } else if (value.is_number_integer()) {
      const auto number = value.get<std::int64_t>();
      is_valid = std::cmp_less_equal(number, kMax) && std::cmp_greater_equal(number, min);
    }
    if (!is_valid) {
      throw InputError(fmt::format("{}: an integer from {} to {} is expected", name, min, kMax));
    }
    return value.get<Integer>();
  }

 private:
  const Json& expect(const char* key, bool is_valid, std::string_view what) const {
    if (!is_valid) throw InputError(fmt::format("{}: {} is expected", path(key), what));
    return json_[key];
  }

  const Json& json_;
  std::string name_;
};

}  // namespace broadmark
