// Messages to the user: the status line, errors to acknowledge, panels to raise.
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

/// A message for the status bar.
struct Message {
  Severity severity = Severity::note;
  std::string text;
};

struct Notices {
  void setStatus(std::string text, Severity severity = Severity::note) {
    status = {severity, std::move(text)};
  }
  /// Reports an error that the user has to acknowledge.
  void reportError(std::string text) {
    setStatus(text, Severity::error);
    errors.push_back(std::move(text));
  }
  /// Calls `action`, and reports its exception as an error. Returns whether it succeeded.
  template <class Action>
  bool catchErrors(const Action& action) {
    try {
      action();
      return true;
    } catch (...) {
      reportError(currentErrorText());
    }
    return false;
  }
  /// Brings a panel to the front in the next picture.
  void raisePanel(std::string panel) { panels_to_raise.push_back(std::move(panel)); }

  /// Called with each opened or saved file.
  std::function<void(const std::filesystem::path&)> on_file_used = [](const auto&) {};
  Message status;
  std::deque<std::string> errors;  ///< not yet acknowledged
  std::vector<std::string> panels_to_raise;
};

}  // namespace broadmark
