// What the inspector remembers from one start to the next.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark {

struct Preferences {
  static constexpr std::size_t kMaxRecent = 10;

  bool dark = true;
  double scale = 0;  ///< of text and widgets; 0: as the screen suggests
  int window_width = 1440;
  int window_height = 860;
  double left = 310;                        ///< width of the panels on the left, in units
  double right = 310;                       ///< width of the panels on the right
  double bottom = 240;                      ///< height of those below
  std::map<std::string, std::string> tabs;  ///< the panel in front, by place
  std::vector<std::string> recent;          ///< files, the latest first

  /// Gives the panels the sizes and places that they have at first.
  void resetLayout();
  /// Puts a file in front of the recent ones.
  void remember(const std::filesystem::path& file);

  friend bool operator==(const Preferences&, const Preferences&) = default;
};

/// $XDG_CONFIG_HOME/broadmark/inspector.json, or below ~/.config.
std::filesystem::path preferencesPath();

/// What cannot be understood keeps its default: bad preferences do not keep the program from
/// starting.
Preferences parsePreferences(std::string_view json);
std::string formatPreferences(const Preferences& preferences);

/// Of a file that is not there: the defaults.
Preferences loadPreferences(const std::filesystem::path& path);
/// Creates the directory. Throws InputError.
void savePreferences(const std::filesystem::path& path, const Preferences& preferences);

}  // namespace broadmark
