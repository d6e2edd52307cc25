// What the user is told: the status line, errors to acknowledge, panels that come to the front.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/error.h"

namespace broadmark {

enum class Severity { note, warning, error };

/// A line for the status bar.
struct Message {
  Severity severity = Severity::note;
  std::string text;
};

struct Notices {
  void say(std::string text, Severity severity = Severity::note) {
    status = {severity, std::move(text)};
  }
  /// An error that the user has to acknowledge.
  void complain(std::string text) {
    say(text, Severity::error);
    errors.push_back(std::move(text));
  }
  /// Does something, turning what it throws into an error. Returns whether all went well.
  template <class Act>
  bool attempt(const Act& act) {
    try {
      act();
      return true;
    } catch (...) {
      complain(currentErrorText());
    }
    return false;
  }
  /// Brings a panel to the front in the next picture.
  void bringUp(std::string panel) { wanted_panels.push_back(std::move(panel)); }

  /// Called with each file that has been opened or saved.
  std::function<void(const std::filesystem::path&)> on_file = [](const auto&) {};
  Message status;
  std::deque<std::string> errors;  ///< not yet acknowledged
  std::vector<std::string> wanted_panels;
};

}  // namespace broadmark
