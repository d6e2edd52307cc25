// Loading algorithms from shared libraries.

#include "plugins.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <string_view>

#include "broadmark/algorithms.h"
#include "broadmark/files.h"
#include "broadmark/error.h"
#include "broadmark/plugin.h"

namespace broadmark {
namespace {

/// The system's reason for its last refusal, without the path in front.
std::string reason(const std::string& path) {
  const char* text = ::dlerror();
  std::string_view message = text == nullptr ? "unknown" : text;
  if (message.starts_with(path + ": ")) message.remove_prefix(path.size() + 2);
  return std::string(message);
}

/// What the library in `file` exports.
const Plugin& load(const std::string& file) {
  openForReading(file);  // it is there, and a regular file
  // With a slash in it the path is that of a file, and searched for nowhere else.
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
    throw InputError(fmt::format("--plugin: {}: built for Broadmark {}, this is {}: build it anew",
                                 file, plugin->interface, kPluginInterface));
  }
  return *plugin;
}

/// An id that can be typed in a list of ids, and means nothing else there.
bool isId(std::string_view id) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyz0123456789-_.";
  return !id.empty() && id != "all" && id.find_first_not_of(kAllowed) == std::string_view::npos;
}

/// All names by which an algorithm is called.
std::vector<std::string> namesOf(const Algorithm& algorithm) {
  std::vector<std::string> names = {algorithm.id};
  for (const OriginalId& original : algorithm.original_ids) names.push_back(original.name);
  return names;
}

void requireSound(const Algorithm& algorithm, const std::vector<Algorithm>& known,
                  const std::string& file) {
  const auto refuse = [&](std::string_view what) {
    throw InputError(fmt::format("--plugin: {}: algorithm '{}': {}", file, algorithm.id, what));
  };
  if (!isId(algorithm.id)) {
    refuse("an id of lower-case letters, digits and -_. other than 'all' is expected");
  }
  if (!algorithm.create || !algorithm.create()) refuse("creates no instance");
  for (const Algorithm& other : known) {
    for (const std::string& name : namesOf(other)) {
      if (std::ranges::count(namesOf(algorithm), name) == 0) continue;
      refuse(fmt::format("the name '{}' is already taken by one {}", name,
                         other.plugin.empty() ? "built in" : "of " + other.plugin));
    }
  }
}

void add(std::vector<Algorithm>& known, const std::string& file) {
  const Plugin& plugin = load(file);
  try {
    for (Algorithm& algorithm : plugin.variants()) {
      requireSound(algorithm, known, file);
      algorithm.plugin = file;
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
