// Parsing and writing JSON: compiled here once, since the library's templates are slow to compile.

#include "broadmark/json_fields.h"

namespace broadmark {
namespace {

/// The library's complaint about a text as ours, with line and column.
InputError notJson(std::string_view name, const nlohmann::detail::exception& error) {
  // Drop the library's own prefix "[json.exception.parse_error.101] ".
  const std::string_view what = error.what();
  const auto end_of_prefix = what.find("] ");
  return InputError(
      fmt::format("{}: not valid JSON: {}", name,
                  what.substr(end_of_prefix == std::string_view::npos ? 0 : end_of_prefix + 2)));
}

/// Visits the keys of the outermost object, and stops where it is told to.
class TopLevelReader : public JsonEvents {
 public:
  using JsonEvents::JsonEvents;

  bool start_object(std::size_t) override {
    in_object_ |= depth_ == 0;
    return open();
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_array() override { return close(); }

 protected:
  [[nodiscard]] bool atTop() const { return in_object_ && depth_ == 1; }

 private:
  bool open() {
    ++depth_;
    return true;
  }
  bool close() {
    --depth_;
    return true;
  }

  std::size_t depth_ = 0;
  bool in_object_ = false;
};

class SchemaReader final : public TopLevelReader {
 public:
  using TopLevelReader::TopLevelReader;

  bool key(string_t& key) override {
    if (atTop()) is_schema_ = key == "schema";
    return true;
  }
  bool string(string_t& text) override {
    if (atTop() && is_schema_) schema_ = text;
    return schema_.empty();
  }
  [[nodiscard]] const std::string& schema() const { return schema_; }

 private:
  bool is_schema_ = false;
  std::string schema_;
};

class KeyFinder final : public TopLevelReader {
 public:
  KeyFinder(std::string_view wanted, std::string_view name)
      : TopLevelReader(name), wanted_(wanted) {}

  bool key(string_t& key) override {
    found_ |= atTop() && key == wanted_;
    return !found_;
  }
  [[nodiscard]] bool found() const { return found_; }

 private:
  std::string_view wanted_;
  bool found_ = false;
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
  SchemaReader reader(name);
  readJson(text, reader);
  return reader.schema();
}

bool jsonHasKey(std::string_view text, std::string_view key, std::string_view name) {
  KeyFinder finder(key, name);
  readJson(text, finder);
  return finder.found();
}

}  // namespace broadmark
