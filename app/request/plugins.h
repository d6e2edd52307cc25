// The available algorithms and physics engines: the built-in ones, and those of shared libraries
// loaded with --plugin.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "request/plugin_guard.h"

namespace broadmark {

/// A plug-in that ships with the program: physics engines and algorithms of an external SDK.
struct SdkPlugin {
  std::string name;      ///< "jolt": argument of --plugin
  std::string package;   ///< "Jolt": argument of CMake's find_package
  std::string releases;  ///< "Jolt Physics 5.5": releases known to work
  bool built = false;    ///< false: its SDK was not found when the program was configured
};

/// All SDK plug-ins, built or not.
std::vector<SdkPlugin> sdkPlugins();

// What stands before the argument of --plugin that is no library.
inline constexpr char kPairLogPrefix[] = "pairs:";      ///< logged_pairs.h: a file
inline constexpr char kExternalPrefix[] = "external:";  ///< external_program.h: a shell command

/// Whether a plug-in has no such prefix.
bool isLibrary(const std::string& plugin);

/// Returns the built-in algorithms, then those of these libraries (see broadmark/plugin.h and
/// broadmark_plugin.h), which stay loaded until the program ends, of pair logs ("pairs:FILE") and
/// of external programs ("external:COMMAND").
/// Throws InputError for a file that is not such a library, was built with other headers, has no
/// algorithm, or one with an invalid or duplicate id, two parameters with one name, or a default
/// out of range.
std::vector<Algorithm> availableAlgorithms(const std::vector<std::string>& plugins);

/// Adds the engines of these libraries to the available ones (see broadmark/scenes/engine_plugin.h)
/// for the rest of the process. Throws InputError like availableAlgorithms(), and for an engine
/// with a parameter that a scene also has. A crash in one then ends the process with a message, as
/// does a frame longer than `limit_seconds`; nullopt: engines are not guarded.
void addEnginesOf(const std::vector<std::string>& plugins,
                  std::optional<double> limit_seconds = kNoEngineLimit);

}  // namespace broadmark
