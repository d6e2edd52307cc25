// Commands other than the main one. A command is one file in this folder and one line in the list
// in CMakeLists.txt.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace broadmark {

/// A command: `broadmark::commands::NAME::command()` for a NAME in the list.
struct Command {
  std::string name;
  std::string summary;
  std::vector<std::string> examples;  ///< arguments: "list scenes"
  /// Adds the options to `app`, which must outlive the returned function. That function runs the
  /// command once `app` has parsed a command line, and returns the exit status. Throws InputError.
  std::function<int()> (*add)(CLI::App& app);
  bool internal = false;  ///< not for users: help does not show it
};

}  // namespace broadmark
