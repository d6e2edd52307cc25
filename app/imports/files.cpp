#include "imports/files.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <cstring>

#include "broadmark/error.h"
#include "broadmark/frame.h"
#include "support/line_reader.h"

namespace broadmark::imports {
namespace {

namespace fs = std::filesystem;

/// The pattern with the characters of its existing folders escaped.
std::string escapedFolders(const std::string& pattern) {
  std::string escaped;
  std::string literal;
  bool exists = true;
  for (std::size_t begin = 0; begin < pattern.size();) {
    const std::size_t end = std::min(pattern.find('/', begin), pattern.size() - 1) + 1;
    const std::string part = pattern.substr(begin, end - begin);
    literal += part;
    std::error_code ignored;
    exists = exists && fs::exists(literal, ignored);
    for (const char c : part) {
      if (exists && std::strchr("*?[\\", c) != nullptr) escaped += '\\';
      escaped += c;
    }
    begin = end;
  }
  return escaped;
}

std::vector<fs::path> matchingFiles(const std::string& pattern) {
  glob_t found{};
  std::vector<fs::path> files;
  if (::glob(escapedFolders(pattern).c_str(), 0, nullptr, &found) == 0) {
    files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
  return files;
}

std::vector<fs::path> filesIn(const std::string& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const bool is_hidden = entry.path().filename().string().starts_with('.');
    std::error_code ignored;
    if (!is_hidden && entry.is_regular_file(ignored)) files.push_back(entry.path());
  }
  if (failed) throw InputError(fmt::format("{}: cannot read: {}", folder, failed.message()));
  return files;
}

/// Without an extension for compression.
fs::path uncompressedName(const fs::path& path) {
  return lowered(path.extension().string()) == ".gz" ? fs::path(path).replace_extension() : path;
}

}  // namespace

bool hasExtension(const fs::path& path, const std::vector<std::string>& extensions) {
  const std::string actual = lowered(uncompressedName(path).extension().string());
  return std::ranges::find(extensions, actual) != extensions.end();
}

std::vector<fs::path> expandName(const std::string& name) {
  std::error_code ignored;
  if (fs::is_directory(name, ignored)) return filesIn(name);
  if (name.find_first_of("*?[") != std::string::npos && !fs::exists(name, ignored)) {
    return matchingFiles(name);
  }
  return {name};
}

void sortNaturally(std::vector<fs::path>& files) {
  // Numbers are compared by value.
  std::ranges::stable_sort(files, [](const fs::path& a, const fs::path& b) {
    return ::strverscmp(a.c_str(), b.c_str()) < 0;
  });
}

std::string sequenceName(const std::vector<fs::path>& files) {
  std::string name = uncompressedName(files.front()).stem().string();
  while (files.size() > 1 && !name.empty() &&
         std::strchr("0123456789-_. ", name.back()) != nullptr) {
    name.pop_back();
  }
  for (char& c : name) {
    if (c < ' ' || c > '~' || c == '/') c = '_';
  }
  if (name.empty()) name = "frames";
  return name.substr(0, kMaxNameLength);
}

}  // namespace broadmark::imports
