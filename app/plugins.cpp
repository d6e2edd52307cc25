// Loading algorithms from shared libraries.

#include "plugins.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <span>
#include <string_view>

#include "broadmark/algorithms.h"
#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/hasher.h"
#include "broadmark/plugin.h"
#include "cases.h"

namespace broadmark {
namespace {

/// Why the last call of the dynamic loader failed, without the path in front.
std::string reason(const std::string& path) {
  const char* text = ::dlerror();
  std::string_view message = text == nullptr ? "unknown" : text;
  if (message.starts_with(path + ": ")) message.remove_prefix(path.size() + 2);
  return std::string(message);
}

/// What the library in `file` exports.
const Plugin& load(const std::string& file) {
  openForReading(file);  // throws unless it is a regular file
  // A path with a slash is not searched for in the loader's directories.
  const std::string path = std::filesystem::absolute(file).string();
  void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    throw InputError(fmt::format("--plugin: {}: cannot be loaded: {}", file, reason(path)));
  }
  const auto* plugin = static_cast<const Plugin*>(::dlsym(library, kPluginSymbol));
  if (plugin == nullptr) {
    throw InputError(
        fmt::format("--plugin: {}: exports no '{}': a library with BROADMARK_PLUGIN is expected",
                    file, kPluginSymbol));
  }
  if (std::string_view(plugin->interface) != kPluginInterface) {
    throw InputError(fmt::format("--plugin: {}: built for Broadmark {}, this is {}: build it again",
                                 file, plugin->interface, kPluginInterface));
  }
  return *plugin;
}

/// Whether an id can be typed in a list of ids without meaning something else.
bool isId(std::string_view id) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyz0123456789-_.";
  return !id.empty() && id != "all" && id.find_first_not_of(kAllowed) == std::string_view::npos;
}

/// Throws InputError for an algorithm that cannot be chosen or made.
void requireSound(const Algorithm& algorithm, const std::vector<Algorithm>& known,
                  const std::string& file) {
  const auto refuse = [&](std::string_view what) {
    throw InputError(fmt::format("--plugin: {}: algorithm '{}': {}", file, algorithm.id, what));
  };
  if (!isId(algorithm.id)) {
    refuse("its id must be made of lower-case letters, digits and -_., and must not be 'all'");
  }
  if (!algorithm.create || !algorithm.create()) refuse("creates no instance");
  if (const Algorithm* other = findAlgorithm(algorithm.id, known)) {
    refuse(fmt::format("its id is already taken by one {}",
                       other->plugin.empty() ? "built in" : "of " + other->plugin));
  }
}

PluginBuild buildOf(const Plugin& plugin, const std::string& file) {
  Hasher hasher;
  const std::string bytes = readTextFile(file);
  hasher.add(std::as_bytes(std::span(bytes)));
  return {.hash = hasher.hex(),
          .flags = plugin.build == nullptr ? "" : plugin.build,
          .unoptimised = !plugin.optimised};
}

void add(std::vector<Algorithm>& known, const std::string& file) {
  const Plugin& plugin = load(file);
  const PluginBuild build = buildOf(plugin, file);
  try {
    for (Algorithm& algorithm : plugin.variants()) {
      requireSound(algorithm, known, file);
      algorithm.plugin = file;
      algorithm.plugin_build = build;
      known.push_back(std::move(algorithm));
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("--plugin: {}: {}", file, error.what()));
  }
}

}  // namespace

std::vector<Algorithm> availableAlgorithms(const std::vector<std::string>& plugins) {
  std::vector<Algorithm> algorithms = builtinAlgorithms();
  for (const std::string& file : plugins) add(algorithms, file);
  return algorithms;
}

}  // namespace broadmark
