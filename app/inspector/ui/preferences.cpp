#include "inspector/ui/preferences.h"

#include <algorithm>
#include <cstdlib>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/json_fields.h"

namespace broadmark {
namespace {

/// Reads a field if it is present and of the right type.
template <class Value>
void readField(const Json& json, const char* key, Value& value) {
  const auto found = json.find(key);
  if (found == json.end()) return;
  try {
    value = found->get<Value>();
  } catch (const Json::exception&) {
    return;
  }
}

/// Calls visit() with the name and the value of each field.
template <class Fields, class Visit>
void visitFields(Fields& preferences, const Visit& visit) {
  visit("dark", preferences.dark);
  visit("scale", preferences.scale);
  visit("window_width", preferences.window_width);
  visit("window_height", preferences.window_height);
  visit("left", preferences.left);
  visit("right", preferences.right);
  visit("bottom", preferences.bottom);
  visit("tabs", preferences.tabs);
  visit("areas", preferences.areas);
  visit("hidden", preferences.hidden);
  visit("folders", preferences.folders);
  visit("recent", preferences.recent);
}

double inRangeOrMin(double value, double min, double max) {
  return value >= min && value <= max ? value : min;
}

}  // namespace

void Preferences::resetLayout() {
  const Preferences defaults;
  left = defaults.left;
  right = defaults.right;
  bottom = defaults.bottom;
  tabs = defaults.tabs;
  areas = defaults.areas;
  hidden = defaults.hidden;
}

void Preferences::remember(const std::filesystem::path& file) {
  std::error_code failed;
  const std::string name = std::filesystem::absolute(file, failed).lexically_normal().string();
  std::erase(recent, name);
  recent.insert(recent.begin(), name);
  if (recent.size() > kMaxRecent) recent.resize(kMaxRecent);
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
  visitFields(read, [&](const char* name, auto& value) { readField(json, name, value); });
  read.scale = read.scale >= 0.5 && read.scale <= 4 ? read.scale : 0;
  read.window_width = std::clamp(read.window_width, 320, 16384);
  read.window_height = std::clamp(read.window_height, 240, 16384);
  read.left = inRangeOrMin(read.left, 120, 4000);
  read.right = inRangeOrMin(read.right, 120, 4000);
  read.bottom = inRangeOrMin(read.bottom, 80, 4000);
  if (read.recent.size() > Preferences::kMaxRecent) read.recent.resize(Preferences::kMaxRecent);
  return read;
}

std::string formatPreferences(const Preferences& preferences) {
  Json json;
  visitFields(preferences, [&](const char* name, const auto& value) { json[name] = value; });
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

void PreferencesFile::update(const Preferences& now, double seconds) {
  constexpr double kDelaySeconds = 1;
  changed_seconds_ = now == saved_ ? 0 : changed_seconds_ + seconds;
  if (changed_seconds_ > kDelaySeconds) save(now);
}

void PreferencesFile::save(const Preferences& now) {
  if (now == saved_) return;
  saved_ = now;
  changed_seconds_ = 0;
  savePreferences(path_, now);
}

}  // namespace broadmark
