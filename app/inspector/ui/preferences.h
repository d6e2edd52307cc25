// Settings that the inspector saves between sessions.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace broadmark {

struct Preferences {
  static constexpr std::size_t kMaxRecent = 10;

  bool dark = true;
  double scale = 0;  ///< of text and widgets; 0: the scale of the screen
  int window_width = 1440;
  int window_height = 860;
  double left = 310;                           ///< width of the panels on the left, in units
  double right = 310;                          ///< width of the panels on the right
  double bottom = 240;                         ///< height of the panels at the bottom
  std::map<std::string, std::string> tabs;     ///< the front panel, by dock area
  std::map<std::string, std::string> areas;    ///< dock areas of moved panels
  std::vector<std::string> hidden;             ///< panels
  std::map<std::string, std::string> folders;  ///< last folder, by title of the file dialog
  std::vector<std::string> recent;             ///< recent files, the latest first

  /// Restores the default sizes and places of the panels, and shows all.
  void resetLayout();
  /// Moves a file to the front of `recent`.
  void remember(const std::filesystem::path& file);

  friend bool operator==(const Preferences&, const Preferences&) = default;
};

/// $XDG_CONFIG_HOME/broadmark/inspector.json, or below ~/.config.
std::filesystem::path preferencesPath();

/// Invalid values get their defaults, so that a damaged file does not prevent startup.
Preferences parsePreferences(std::string_view json);
std::string formatPreferences(const Preferences& preferences);

/// Returns the defaults if the file cannot be read.
Preferences loadPreferences(const std::filesystem::path& path);
/// Creates the directory. Throws InputError.
void savePreferences(const std::filesystem::path& path, const Preferences& preferences);

/// Saves preferences soon after they have changed, so that a killed process loses none.
class PreferencesFile {
 public:
  /// `saved`: what the file holds.
  PreferencesFile(std::filesystem::path path, Preferences saved)
      : path_(std::move(path)), saved_(std::move(saved)) {}

  /// Call once per picture; saves once they have stayed changed for a second. Throws InputError.
  void update(const Preferences& now, double seconds);
  /// Saves them if they have changed. Throws InputError, once for these.
  void save(const Preferences& now);

 private:
  std::filesystem::path path_;
  Preferences saved_;
  double changed_seconds_ = 0;
};

}  // namespace broadmark
