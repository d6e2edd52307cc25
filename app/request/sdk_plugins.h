// The plug-ins that come with the program: physics engines and algorithms of SDKs that are not part
// of it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace broadmark {

struct SdkPlugin {
  std::string name;            ///< "jolt": what --plugin takes
  std::string package;         ///< "Jolt": what CMake's find_package looks for
  std::string releases;        ///< "Jolt Physics 5.5": those that are known to do
  bool built = false;          ///< false: its SDK was not found when the program was configured
  std::filesystem::path file;  ///< if it was built
};

/// All of them, whether built or not.
std::vector<SdkPlugin> sdkPlugins();

/// The file that is meant by what was given to --plugin: the name of one of these, or a path.
/// Throws InputError for one that was not built.
std::string pluginFile(const std::string& named);

}  // namespace broadmark
