#include "request/former_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <set>
#include <string_view>

#include "broadmark/parameters.h"

namespace broadmark {
namespace {

struct FormerName {
  std::string_view command;  ///< "": the main command
  std::string_view former;
  std::string_view current;
};

constexpr FormerName kFormerNames[] = {
    {"", "--most-seconds", "--max-seconds"},
    {"duel", "--seconds", "--max-seconds"},
    {"duel", "--with", "--baseline-program"},
    {"compare", "--with", "--baseline-program"},
    {"script", "settled", "idle"},
    {"script", "lane", "algorithm"},
    {"script", "lanes", "algorithms"},
    {"script", "shown_lane", "shown_algorithm"},
};

/// Returns the current name; prints a note the first time that it differs from the former one.
std::string renamed(std::string_view former, std::string_view current) {
  static std::set<std::string, std::less<>> reported;
  if (former != current && reported.emplace(former).second) {
    fmt::print(stderr, "broadmark: '{}' is now called '{}'\n", former, current);
  }
  return std::string(current);
}

std::string currentName(std::string_view command, std::string_view name) {
  for (const FormerName& entry : kFormerNames) {
    if (entry.command == command && entry.former == name) return renamed(name, entry.current);
  }
  return std::string(name);
}

}  // namespace

std::vector<std::string> withCurrentOptions(std::vector<std::string> arguments) {
  std::string command;
  for (const FormerName& entry : kFormerNames) {
    if (!arguments.empty() && arguments.front() == entry.command) command = entry.command;
  }
  for (std::string& argument : arguments) {
    if (argument == "--") break;
    const std::size_t end = std::min(argument.find('='), argument.size());
    argument = currentName(command, argument.substr(0, end)) + argument.substr(end);
  }
  return arguments;
}

std::string currentOption(const std::string& option) { return currentName("", option); }

std::string currentScriptWord(const std::string& word) {
  const std::size_t end = std::min(word.find('.'), word.size());
  return currentName("script", word.substr(0, end)) + word.substr(end);
}

std::string currentParameterKey(const std::string& key) {
  const std::size_t colon = key.rfind(':');
  const std::size_t begin = colon == key.npos ? 0 : colon + 1;
  const std::string name = key.substr(begin);
  return key.substr(0, begin) + renamed(name, currentParameterName(name));
}

}  // namespace broadmark
