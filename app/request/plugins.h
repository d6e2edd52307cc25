// The available algorithms and physics engines: the built-in ones, and those of shared libraries
// loaded with --plugin.
#pragma once

#include <filesystem>
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
/// Path of a plug-in that ships with the program: beside it in a build, in the library folder when
/// installed.
std::filesystem::path shippedPlugin(const std::string& name);

// What stands before the argument of --plugin that is no library.
inline constexpr char kPairLogPrefix[] = "pairs:";      ///< logged_pairs.h: a file
inline constexpr char kExternalPrefix[] = "external:";  ///< external_program.h: a shell command

/// Whether a plug-in has no such prefix.
bool isLibrary(const std::string& plugin);

/// The plug-in of a file: a library by its extension, else a program if it can be executed, else a
/// log of pairs.
std::string pluginOf(const std::filesystem::path& file);
/// The files that decide what a plug-in is: a library, a log, or all that a command names.
std::vector<std::filesystem::path> pluginFiles(const std::string& plugin);

/// How a library is loaded: where it is, or as a copy in memory, so that its file may be replaced
/// meanwhile, and loaded again.
enum class PluginLoading { in_place, copy };

/// Returns the built-in algorithms, then those of these libraries (see broadmark/plugin.h and
/// broadmark_plugin.h), which stay loaded until the program ends, of pair logs ("pairs:FILE") and
/// of external programs ("external:COMMAND").
/// Throws InputError for a file that is not such a library, was built with other headers, has no
/// algorithm, or one with an invalid or duplicate id, two parameters with one name, or a default
/// out of range.
std::vector<Algorithm> availableAlgorithms(const std::vector<std::string>& plugins,
                                           PluginLoading loading = PluginLoading::in_place);
/// The algorithms of one plug-in; none of a library with engines only. Throws InputError in the
/// same way, and if an id is that of a `known` algorithm.
std::vector<Algorithm> algorithmsOf(const std::string& plugin, const std::vector<Algorithm>& known,
                                    PluginLoading loading);

/// Adds the engines of these libraries to the available ones (see broadmark/scenes/engine_plugin.h)
/// for the rest of the process. Throws InputError like availableAlgorithms(), and for an engine
/// with a parameter that a scene also has. A crash in one then ends the process with a message, as
/// does a frame longer than `limit_seconds`; nullopt: engines are not guarded.
void addEnginesOf(const std::vector<std::string>& plugins,
                  std::optional<double> limit_seconds = kNoEngineLimit,
                  PluginLoading loading = PluginLoading::in_place);

}  // namespace broadmark
