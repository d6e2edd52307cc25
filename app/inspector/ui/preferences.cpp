#include "inspector/ui/preferences.h"

#include <algorithm>
#include <cstdlib>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/json_fields.h"

namespace broadmark {
namespace {

/// Takes a value over if it is there and of the right type.
template <class Value>
void take(const Json& json, const char* key, Value& value) {
  const auto found = json.find(key);
  if (found == json.end()) return;
  try {
    value = found->get<Value>();
  } catch (const Json::exception&) {
  }
}

double within(double value, double low, double high) {
  return value >= low && value <= high ? value : low;
}

}  // namespace

void Preferences::resetLayout() {
  const Preferences first;
  left = first.left;
  right = first.right;
  bottom = first.bottom;
  tabs = first.tabs;
}

void Preferences::remember(const std::filesystem::path& file) {
  std::error_code failed;
  const std::string name = std::filesystem::absolute(file, failed).lexically_normal().string();
  std::erase(recent, name);
  recent.insert(recent.begin(), name);
  if (recent.size() > kMostRecent) recent.resize(kMostRecent);
}

std::filesystem::path preferencesPath() {
  const char* config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && *config == '/') {
    return std::filesystem::path(config) / "broadmark/inspector.json";
  }
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home != nullptr ? home : "/") / ".config/broadmark/inspector.json";
}

Preferences parsePreferences(std::string_view text) {
  Preferences read;
  const Json json = jsonOrNull(text);
  if (!json.is_object()) return read;
  take(json, "dark", read.dark);
  take(json, "scale", read.scale);
  take(json, "window_width", read.window_width);
  take(json, "window_height", read.window_height);
  take(json, "left", read.left);
  take(json, "right", read.right);
  take(json, "bottom", read.bottom);
  take(json, "tabs", read.tabs);
  take(json, "recent", read.recent);
  read.scale = read.scale >= 0.5 && read.scale <= 4 ? read.scale : 0;
  read.window_width = std::clamp(read.window_width, 320, 16384);
  read.window_height = std::clamp(read.window_height, 240, 16384);
  read.left = within(read.left, 120, 4000);
  read.right = within(read.right, 120, 4000);
  read.bottom = within(read.bottom, 80, 4000);
  if (read.recent.size() > Preferences::kMostRecent) read.recent.resize(Preferences::kMostRecent);
  return read;
}

std::string formatPreferences(const Preferences& preferences) {
  const Json json = {{"dark", preferences.dark},
                     {"scale", preferences.scale},
                     {"window_width", preferences.window_width},
                     {"window_height", preferences.window_height},
                     {"left", preferences.left},
                     {"right", preferences.right},
                     {"bottom", preferences.bottom},
                     {"tabs", preferences.tabs},
                     {"recent", preferences.recent}};
  return formatJson(json, 2);
}

Preferences loadPreferences(const std::filesystem::path& path) {
  try {
    return parsePreferences(readTextFile(path));
  } catch (const InputError&) {
    return {};
  }
}

void savePreferences(const std::filesystem::path& path, const Preferences& preferences) {
  std::error_code failed;
  std::filesystem::create_directories(path.parent_path(), failed);
  writeTextFile(path, formatPreferences(preferences));
}

}  // namespace broadmark
