#include "request/sdk_plugins.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "broadmark/error.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Where they lie: beside the program in a build, in the folder of libraries when installed.
fs::path fileOf(const std::string& name) {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  const fs::path folder = program.parent_path();
  const fs::path built = folder / "plugins" / (name + ".so");
  return fs::exists(built, failed)
             ? built
             : (folder / BROADMARK_PLUGIN_FOLDER / (name + ".so")).lexically_normal();
}

}  // namespace

std::vector<SdkPlugin> sdkPlugins() {
  std::vector<SdkPlugin> all;
#define SDK_PLUGIN(name, package, releases, built) \
  all.push_back({name, package, releases, built, (built) ? fileOf(name) : fs::path()});
#include "sdk_plugins.inc"
#undef SDK_PLUGIN
  return all;
}

std::string pluginFile(const std::string& named) {
  const std::vector<SdkPlugin> all = sdkPlugins();
  const auto meant = std::ranges::find(all, named, &SdkPlugin::name);
  if (meant == all.end()) return named;
  if (!meant->built) {
    throw InputError(
        fmt::format("--plugin: {}: not built: {} was not found when this program was configured "
                    "(find_package({}), see 'Physics SDKs' in the README)",
                    named, meant->releases, meant->package));
  }
  return meant->file.string();
}

}  // namespace broadmark
