#include "command_line/run_requests.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "broadmark/json_fields.h"
#include "broadmark/names.h"
#include "command_line/session_options.h"
#include "command_line/usage.h"
#include "request/former_names.h"
#include "request/sweep.h"

namespace broadmark {
namespace {

/// Converts "--order-seed" to "order_seed"; returns "source" unchanged.
std::string keyOf(std::string key) {
  key.erase(0, key.find_first_not_of('-'));
  std::ranges::replace(key, '-', '_');
  return key;
}

std::string keyOf(const CLI::Option& option) { return keyOf(option.get_name()); }

/// Converts "order_seed" to "--order-seed".
std::string optionOf(std::string key) {
  std::ranges::replace(key, '_', '-');
  return "--" + key;
}

/// Whether several values are given by repeating the option, as they may contain commas.
bool isRepeated(const std::string& key) {
  return key == "source" || key == "plugin" || key == "param";
}

/// Returns a number if it is formatted like the text, else the text.
Json valueOf(const std::string& text) {
  Json number = jsonOrNull(text);
  return number.is_number() && number.dump() == text ? number : Json(text);
}

/// Parses the value of an option; `text` has one line per repetition of the option.
Json valueOf(const CLI::Option& option, const std::string& text) {
  if (option.get_items_expected_max() == 0)
    return takesOptionalValue(option) ? Json(text) : Json(true);
  if (option.get_items_expected_max() == 1) return valueOf(text);
  const std::string key = keyOf(option);
  if (!isRepeated(key)) {
    Json values = Json::array();
    for (const std::string& part : splitList({text})) values.push_back(valueOf(part));
    return values;
  }
  Json values = key == "param" ? Json::object() : Json::array();
  for (const std::string& line : CLI::detail::split(text, '\n')) {
    const std::size_t equals = line.find('=');
    if (key == "param") {
      values[line.substr(0, equals)] = valueOf(line.substr(equals + 1));
    } else {
      values.push_back(line);
    }
  }
  return values;
}

/// Formats a value for the command line: an array as its elements, separated by commas.
std::string textOf(const Json& value, const std::string& path) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number() || value.is_boolean()) return value.dump();
  if (!value.is_array()) {
    throw InputError(path + ": a string, a number or an array of these is expected");
  }
  std::vector<std::string> parts;
  for (const Json& element : value) {
    if (element.is_array()) throw InputError(path + ": arrays must not be nested");
    parts.push_back(textOf(element, path));
  }
  return fmt::format("{}", fmt::join(parts, ","));
}

/// Returns the texts of an option's value, one per repetition of the option.
std::vector<std::string> textsOf(const std::string& key, const Json& value,
                                 const std::string& path) {
  std::vector<std::string> texts;
  if (key == "param") {
    if (!value.is_object()) throw InputError(path + ": an object of parameters is expected");
    for (const auto& [name, text] : value.items()) {
      texts.push_back(fmt::format("{}={}", name, textOf(text, fmt::format("{}: {}", path, name))));
    }
  } else if (isRepeated(key) && value.is_array()) {
    for (const Json& element : value) texts.push_back(textOf(element, path));
  } else {
    texts.push_back(textOf(value, path));
  }
  return texts;
}

}  // namespace

std::string formatRunRequest(const RunRequest& request) {
  CLI::App app;
  SessionParser session(app);
  session.set(request);
  Json json = {{"schema", kRunSchema}};
  for (CLI::Option* option : app.get_options()) {
    if (!session.isRequestOption(*option)) continue;
    const std::string default_text = option->get_default_str();
    const std::string text = option->capture_default_str()->get_default_str();
    if (text != default_text) json[keyOf(*option)] = valueOf(*option, text);
  }
  return formatJson(json);
}

std::vector<std::string> argumentsOf(std::string_view text, const std::string& name,
                                     const CLI::App& app, const SessionParser& session) {
  const Json json = parseJson(text, name);
  const JsonFields fields(json, name);
  if (!fields.has("schema") || fields.text("schema") != kRunSchema) {
    throw InputError(
        fmt::format("{}: not a run request: \"schema\" must be '{}'", name, kRunSchema));
  }
  std::vector<const CLI::Option*> options;
  std::vector<std::string> keys;
  for (const CLI::Option* option : app.get_options()) {
    if (!session.isRequestOption(*option)) continue;
    options.push_back(option);
    keys.push_back(keyOf(*option));
  }
  std::vector<std::string> arguments;
  for (const auto& [given, value] : json.items()) {
    if (given == "schema") continue;
    const std::string key = keyOf(currentOption(optionOf(given)));
    const auto found = std::ranges::find(keys, key);
    if (found == keys.end())
      throw InputError(fmt::format("{}: {}", name, unknownName("key", key, keys)));
    const CLI::Option& option = *options[static_cast<std::size_t>(found - keys.begin())];
    if (option.count() > 0 || value.is_null() || value == false) continue;
    const std::string path = fields.path(key.c_str());
    const bool may_have_value = option.get_items_expected_max() > 0 || takesOptionalValue(option);
    if (!may_have_value || (value == true && takesOptionalValue(option))) {
      if (value != true) throw InputError(path + ": true or false is expected");
      arguments.push_back(option.get_name());
      continue;
    }
    for (std::string& argument : textsOf(key, value, path)) {
      // As a single word, so that a value may start with a dash.
      arguments.push_back(option.get_positional()
                              ? std::move(argument)
                              : fmt::format("{}={}", option.get_name(), argument));
    }
  }
  return arguments;
}

}  // namespace broadmark
