#include "support/output.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <iterator>

#include "broadmark/error.h"
#include "broadmark/files.h"

namespace broadmark {
namespace {

/// Canonical path of a file; the path itself if there is none, as for a pipe.
std::filesystem::path canonicalPath(const std::filesystem::path& path) {
  if (isStandardOutput(path)) return "-";
  std::error_code failed;
  std::filesystem::path canonical = std::filesystem::weakly_canonical(path, failed);
  return failed ? path : canonical;
}

}  // namespace

bool isStandardOutput(const std::filesystem::path& path) {
  return path == "-" || path == "/dev/stdout";
}

bool useStandardOutput(const OutputPaths& paths) {
  return std::ranges::any_of(paths,
                             [](const auto& output) { return isStandardOutput(output.second); });
}

void requireOutput(const std::filesystem::path& path) {
  if (!isStandardOutput(path)) AtomicFile probe(path);
}

void OutputFiles::addSource(const std::filesystem::path& path) {
  if (!path.empty()) used_by_[canonicalPath(path)] = "a source";
}

void OutputFiles::require(const std::string& option, const std::filesystem::path& path) {
  const auto [other, is_free] = used_by_.emplace(canonicalPath(path), option);
  if (!is_free) {
    throw InputError(fmt::format("{}: {}: already used for {}: choose another name", option,
                                 path.string(), other->second));
  }
  requireOutput(path);
}

void OutputFiles::require(const OutputPaths& paths) {
  for (const auto& [name, path] : paths) require("--" + name, path);
}

std::string readInput(const std::filesystem::path& path) {
  if (path != "-") return readTextFile(path);
  return {std::istreambuf_iterator<char>(std::cin), {}};
}

std::size_t outputWidth() {
  constexpr std::size_t kMin = 40;
  constexpr std::size_t kDefault = 80;
  std::size_t columns = 0;
  if (const char* text = std::getenv("COLUMNS")) {
    std::from_chars(text, text + std::strlen(text), columns);
  }
  winsize size{};
  if (columns == 0 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) columns = size.ws_col;
  return columns == 0 ? kDefault : std::max(columns, kMin);
}

void writeOutput(const std::filesystem::path& path, std::string_view text) {
  if (!isStandardOutput(path)) return writeTextFile(path, text);
  // main() reports write errors.
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace broadmark
