// What the user is told: the status line, errors to acknowledge, panels that come to the front.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace broadmark {

/// A line for the status bar.
struct Message {
  enum class Kind { note, warning, error };
  Kind kind = Kind::note;
  std::string text;
};

struct Notices {
  void say(std::string text, Message::Kind kind = Message::Kind::note);
  /// An error that the user has to acknowledge.
  void complain(std::string text);
  /// Does something, turning what it throws into an error. Returns whether all went well.
  bool attempt(const std::function<void()>& act);
  /// Brings a panel to the front in the next picture.
  void bringUp(std::string panel) { wanted_panels.push_back(std::move(panel)); }

  /// Reports a file that has been opened or saved.
  void noteFile(const std::filesystem::path& file) const {
    if (on_file) on_file(file);
  }

  std::function<void(const std::filesystem::path&)> on_file;  ///< set by the owner
  Message status;
  std::deque<std::string> errors;  ///< not yet acknowledged
  std::vector<std::string> wanted_panels;
};

}  // namespace broadmark
