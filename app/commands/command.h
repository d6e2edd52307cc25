// The commands besides the main one. A new command is one file in this folder and one line in the
// list in CMakeLists.txt.
#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace broadmark {

/// A command: `broadmark::commands::NAME::command()` for a NAME in the list.
struct Command {
  std::string name;
  std::string summary;
  /// Adds its options to `app`. Returns what runs it once `app`, which lives as long, has parsed a
  /// command line, and returns the exit status; that throws InputError.
  std::function<int()> (*add)(CLI::App& app);
};

}  // namespace broadmark
