// Parsing and writing JSON: compiled here once, since the library's templates are slow to compile.

#include "broadmark/json_fields.h"

namespace broadmark {
namespace {

/// Converts the library's error, with line and column.
InputError notJson(std::string_view name, const nlohmann::detail::exception& error) {
  // Drop the library's own prefix "[json.exception.parse_error.101] ".
  const std::string_view what = error.what();
  const auto end_of_prefix = what.find("] ");
  return InputError(
      fmt::format("{}: not valid JSON: {}", name,
                  what.substr(end_of_prefix == std::string_view::npos ? 0 : end_of_prefix + 2)));
}

/// Searches for a key of the outermost object, and for its string value.
class KeyReader final : public JsonEvents {
 public:
  /// Stops at the key, or at its value if that is requested.
  KeyReader(std::string_view key, bool reads_value, std::string_view name)
      : JsonEvents(name), key_(key), reads_value_(reads_value) {}

  bool start_object(std::size_t) override {
    in_object_ |= depth_ == 0;
    ++depth_;
    return true;
  }
  bool end_object() override { return end_array(); }
  bool start_array(std::size_t) override {
    ++depth_;
    return true;
  }
  bool end_array() override {
    --depth_;
    return true;
  }
  bool key(string_t& name) override {
    if (isAtTop()) found_ = name == key_;
    return reads_value_ || !found_;
  }
  bool string(string_t& text) override {
    if (isAtTop() && found_) text_ = text;
    return text_.empty();
  }

  /// Whether the last key of the outermost object is the requested one.
  [[nodiscard]] bool found() const { return found_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  [[nodiscard]] bool isAtTop() const { return in_object_ && depth_ == 1; }

  std::string_view key_;
  bool reads_value_;
  std::size_t depth_ = 0;
  bool in_object_ = false;
  bool found_ = false;
  std::string text_;
};

std::string dumped(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Json parseJson(std::string_view text, std::string_view name) {
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {  // out_of_range for numbers like 1e999
    throw notJson(name, error);
  }
}

Json jsonOrNull(std::string_view text) {
  Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  return json.is_discarded() ? nullptr : json;
}

std::string formatJson(const Json& json, int indent) { return dumped(json, indent) + '\n'; }

std::string compactJson(const Json& json) { return dumped(json, -1); }

std::string onOneLine(const std::string& text) {
  const std::string quoted = compactJson(text);
  return quoted.substr(1, quoted.size() - 2);
}

bool JsonEvents::parse_error(std::size_t, const std::string&,
                             const nlohmann::detail::exception& error) {
  throw notJson(name_, error);
}

void readJson(std::string_view text, JsonEvents& events) { Json::sax_parse(text, &events); }

std::string jsonSchema(std::string_view text, std::string_view name) {
  KeyReader reader("schema", true, name);
  readJson(text, reader);
  return reader.text();
}

bool jsonHasKey(std::string_view text, std::string_view key, std::string_view name) {
  KeyReader reader(key, false, name);
  readJson(text, reader);
  return reader.found();
}

}  // namespace broadmark
