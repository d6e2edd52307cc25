// Loading algorithms and physics engines from shared libraries.

#include "request/plugins.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iterator>
#include <set>
#include <span>
#include <string_view>

#include "broadmark/algorithms.h"
#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/harness/shared_memory.h"
#include "broadmark/hasher.h"
#include "broadmark/plugin.h"
#include "broadmark/scenes/engine_plugin.h"
#include "broadmark/scenes/simulation.h"
#include "request/c_plugin.h"
#include "request/cases.h"
#include "request/external_program.h"
#include "request/logged_pairs.h"
#include "request/plugin_guard.h"
#include "support/words.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Error message of the last call of the dynamic loader, without the leading path.
std::string loaderError(const std::string& path) {
  const char* text = ::dlerror();
  std::string_view message = text == nullptr ? "unknown" : text;
  if (message.starts_with(path + ": ")) message.remove_prefix(path.size() + 2);
  return std::string(message);
}

/// Resolves the name of an SDK plug-in, or a path, to a file. Throws InputError for an SDK plug-in
/// that was not built.
std::string pluginFile(const std::string& name_or_path) {
  const std::vector<SdkPlugin> all = sdkPlugins();
  const auto plugin = std::ranges::find(all, name_or_path, &SdkPlugin::name);
  if (plugin == all.end()) return name_or_path;
  if (!plugin->built) {
    throw InputError(
        fmt::format("--plugin: {}: not built: {} was not found when this program was configured "
                    "(find_package({}), see docs/installing.md)",
                    name_or_path, plugin->releases, plugin->package));
  }
  return shippedPlugin(name_or_path).string();
}

/// Loads a copy of a library; null if that is impossible, as when it needs others beside it.
void* loadCopy(const std::string& file) {
  static std::vector<SharedMemory> copies;  // kept open, so that each has a name of its own
  const SharedMemory& copy = copies.emplace_back();
  const std::string bytes = readTextFile(file);
  copy.write(std::span(bytes.data(), bytes.size()));
  return ::dlopen(fmt::format("/proc/self/fd/{}", copy.descriptor()).c_str(),
                  RTLD_NOW | RTLD_LOCAL);
}

/// Loads a plug-in, which stays loaded.
void* load(const std::string& name_or_path, PluginLoading loading) {
  const std::string file = pluginFile(name_or_path);
  openForReading(file);  // throws unless it is a regular file
  // A path with a slash is not searched for in the loader's directories.
  const std::string path = fs::absolute(file).string();
  void* library = loading == PluginLoading::copy ? loadCopy(file) : nullptr;
  if (library == nullptr) library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    throw InputError(fmt::format("--plugin: {}: cannot be loaded: {}", file, loaderError(path)));
  }
  const char* const symbols[] = {kAlgorithmPluginSymbol, scenes::kEnginePluginSymbol,
                                 kCPluginSymbol};
  if (std::ranges::none_of(
          symbols, [&](const char* symbol) { return ::dlsym(library, symbol) != nullptr; })) {
    throw InputError(
        fmt::format("--plugin: {}: exports none of '{}': a library with BROADMARK_PLUGIN, "
                    "BROADMARK_ENGINE_PLUGIN or the function of broadmark_plugin.h is expected",
                    file, fmt::join(symbols, "', '")));
  }
  return library;
}

/// Returns a library's export with this name, or null. `file` is for messages.
template <class Entry>
const Plugin<Entry>* exportOf(void* library, const std::string& file, const char* symbol) {
  const auto* plugin = static_cast<const Plugin<Entry>*>(::dlsym(library, symbol));
  if (plugin != nullptr && std::string_view(plugin->interface) != kPluginInterface) {
    throw InputError(fmt::format("--plugin: {}: built for Broadmark {}, this is {}: build it again",
                                 file, plugin->interface, kPluginInterface));
  }
  return plugin;
}

/// Whether an id is unambiguous in a list of ids.
bool isId(std::string_view id) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyz0123456789-_.";
  return !id.empty() && id != "all" && id.find_first_not_of(kAllowed) == std::string_view::npos;
}

/// Throws InputError about an entry of a plug-in.
[[noreturn]] void refuse(const std::string& file, std::string_view kind, std::string_view id,
                         std::string_view reason) {
  throw InputError(fmt::format("--plugin: {}: {} '{}': {}", file, kind, id, reason));
}

/// Throws InputError for an entry that cannot be selected or created. `other` is the plug-in of an
/// existing entry with the same id, or null.
void requireValid(const std::string& file, std::string_view kind, std::string_view id, bool creates,
                  const std::string* other) {
  if (!isId(id)) {
    refuse(file, kind, id,
           "its id must be made of lower-case letters, digits and -_., and must not be 'all'");
  }
  if (!creates) refuse(file, kind, id, "creates no instance");
  if (other == nullptr) return;
  refuse(file, kind, id,
         fmt::format("its id is already taken by one {}",
                     other->empty() ? "built in" : "of " + *other));
}

/// Throws InputError for two parameters with one name, or a default out of range.
void requireValidParameters(const std::string& file, std::string_view kind, std::string_view id,
                            Parametrised& object) {
  std::set<std::string> names;
  object.visitParameters([&](const Parameter& parameter) {
    if (!names.emplace(parameter.name).second) {
      refuse(file, kind, id, fmt::format("has two parameters '{}'", parameter.name));
    }
    try {
      setParameter(parameter, parameterText(parameter));
    } catch (const InputError& error) {
      refuse(file, kind, id, fmt::format("default out of range: {}", error.what()));
    }
  });
}

/// Returns create(), guarded against a crash; null without a `create`.
template <class Create, class... Arguments>
auto instanceOf(const std::string& file, std::string_view kind, std::string_view id,
                const Create& create, const Arguments&... arguments)
    -> decltype(create(arguments...)) {
  if (!create) return nullptr;
  const PluginCall call(fmt::format("{} '{}' of {}: creation", kind, id, file));
  return create(arguments...);
}

/// Throws InputError for an engine that cannot be selected or created, or that has a parameter with
/// the name of a scene's parameter.
void requireValid(const scenes::EngineEntry& engine, const std::string& file) {
  constexpr std::string_view kKind = "engine";
  const std::string& id = engine.listing.id;
  const std::vector<EngineListing> known = availableEngines();
  const auto other = std::ranges::find(known, id, &EngineListing::id);
  const auto instance = instanceOf(file, kKind, id, engine.create, scenes::PhysicsSettings());
  requireValid(file, kKind, id, instance != nullptr,
               other == known.end() ? nullptr : &other->plugin);
  requireValidParameters(file, kKind, id, *instance);
  const std::vector<std::string> names = parameterNames(*instance);
  for (const SceneListing& scene : builtinScenes()) {
    const std::vector<std::string> reserved = parameterNames(*makeSimulation(scene.id));
    for (const std::string& name : names) {
      if (std::ranges::find(reserved, name) == reserved.end()) continue;
      refuse(
          file, kKind, id,
          fmt::format("its parameter '{}' needs another name: scene '{}' has one", name, scene.id));
    }
  }
}

std::string hashOf(const std::string& file) {
  Hasher hasher;
  const std::string bytes = readTextFile(pluginFile(file));
  hasher.add(std::as_bytes(std::span(bytes)));
  return hasher.hex();
}

/// The entries of a plug-in. Throws InputError if it has none.
template <class Entry>
std::vector<Entry> entriesOf(const Plugin<Entry>& plugin, const std::string& file,
                             std::string_view kind) {
  try {
    std::vector<Entry> entries = plugin.entries();
    if (!entries.empty()) return entries;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("--plugin: {}: {}", file, error.what()));
  }
  throw InputError(fmt::format("--plugin: {}: has no {}s", file, kind));
}

/// Algorithms that come from no library.
struct OtherSource {
  std::string_view prefix;
  Algorithm (*open)(const std::string& argument);
};
constexpr OtherSource kOtherSources[] = {{kPairLogPrefix, loggedPairs},
                                         {kExternalPrefix, externalAlgorithm}};

/// Null for a library.
const OtherSource* otherSource(const std::string& plugin) {
  const auto* const found = std::ranges::find_if(
      kOtherSources, [&](const OtherSource& source) { return plugin.starts_with(source.prefix); });
  return found == std::end(kOtherSources) ? nullptr : found;
}

/// The algorithm of a pair log or a program, or those that a library exports through either
/// interface; it may have engines instead.
std::vector<Algorithm> algorithmsIn(const std::string& file, PluginLoading loading) {
  if (const OtherSource* source = otherSource(file)) {
    Algorithm algorithm = source->open(file.substr(source->prefix.size()));
    algorithm.plugin = file;
    return {std::move(algorithm)};
  }
  void* const library = load(file, loading);
  std::vector<Algorithm> algorithms;
  PluginBuild build;
  if (const auto* plugin = exportOf<Algorithm>(library, file, kAlgorithmPluginSymbol)) {
    algorithms = entriesOf(*plugin, file, "algorithm");
    build = {.flags = plugin->build == nullptr ? "" : plugin->build,
             .unoptimised = !plugin->optimised};
  }
  if (void* const function = ::dlsym(library, kCPluginSymbol)) {
    const auto table = reinterpret_cast<decltype(&broadmark_c_plugin)>(function);
    std::ranges::move(algorithmsOf(table(), file), std::back_inserter(algorithms));
  }
  if (!algorithms.empty()) build.hash = hashOf(file);
  for (Algorithm& algorithm : algorithms) {
    algorithm.plugin = file;
    algorithm.plugin_build = build;
  }
  return algorithms;
}

}  // namespace

fs::path shippedPlugin(const std::string& name) {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  const fs::path folder = program.parent_path();
  const fs::path built = folder / "plugins" / (name + ".so");
  return fs::exists(built, failed)
             ? built
             : (folder / BROADMARK_PLUGIN_FOLDER / (name + ".so")).lexically_normal();
}

std::vector<SdkPlugin> sdkPlugins() {
  std::vector<SdkPlugin> all;
#define SDK_PLUGIN(name, package, releases, built) all.push_back({name, package, releases, built});
#include "sdk_plugins.inc"
#undef SDK_PLUGIN
  return all;
}

bool isLibrary(const std::string& plugin) { return otherSource(plugin) == nullptr; }

std::string pluginOf(const std::filesystem::path& file) {
  std::string path = fs::absolute(file).string();
  if (file.extension() == ".so") return path;
  return ::access(path.c_str(), X_OK) == 0 ? kExternalPrefix + shellQuoted(path)
                                           : kPairLogPrefix + path;
}

std::vector<fs::path> pluginFiles(const std::string& plugin) {
  const OtherSource* const source = otherSource(plugin);
  if (source == nullptr) return {pluginFile(plugin)};
  std::string argument = plugin.substr(source->prefix.size());
  std::erase(argument, '\'');
  std::vector<fs::path> files = {argument};
  if (source->prefix == kExternalPrefix)
    std::ranges::copy(splitAt(' ', argument), std::back_inserter(files));
  std::erase_if(files, [](const fs::path& file) { return !fs::is_regular_file(file); });
  return files;
}

std::vector<Algorithm> algorithmsOf(const std::string& plugin, const std::vector<Algorithm>& known,
                                    PluginLoading loading) {
  constexpr std::string_view kKind = "algorithm";
  std::vector<Algorithm> algorithms;
  for (Algorithm& algorithm : algorithmsIn(plugin, loading)) {
    const Algorithm* other = findAlgorithm(algorithm.id, known);
    if (other == nullptr) other = findAlgorithm(algorithm.id, algorithms);
    const auto instance = instanceOf(plugin, kKind, algorithm.id, algorithm.create);
    requireValid(plugin, kKind, algorithm.id, instance != nullptr,
                 other == nullptr ? nullptr : &other->plugin);
    requireValidParameters(plugin, kKind, algorithm.id, *instance);
    algorithms.push_back(std::move(algorithm));
  }
  return algorithms;
}

std::vector<Algorithm> availableAlgorithms(const std::vector<std::string>& plugins,
                                           PluginLoading loading) {
  std::vector<Algorithm> algorithms = builtinAlgorithms();
  for (const std::string& file : plugins) {
    std::ranges::move(algorithmsOf(file, algorithms, loading), std::back_inserter(algorithms));
  }
  return algorithms;
}

void addEnginesOf(const std::vector<std::string>& plugins, std::optional<double> limit_seconds,
                  PluginLoading loading) {
  if (!plugins.empty() && limit_seconds) guardEngines(*limit_seconds);
  for (const std::string& file : plugins) {
    if (!isLibrary(file)) continue;
    const auto* plugin =
        exportOf<scenes::EngineEntry>(load(file, loading), file, scenes::kEnginePluginSymbol);
    if (plugin == nullptr) continue;
    for (scenes::EngineEntry& engine : entriesOf(*plugin, file, "engine")) {
      requireValid(engine, file);
      engine.listing.plugin = file;
      scenes::addEngine(std::move(engine));
    }
  }
}

}  // namespace broadmark
