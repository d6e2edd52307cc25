#include "imports/files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glob.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "broadmark/error.h"
#include "broadmark/frame.h"

namespace broadmark::imports {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> matches(const std::string& pattern) {
  glob_t found{};
  std::vector<std::string> paths;
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
  return paths;
}

/// In a folder.
std::vector<std::string> filesIn(const std::string& folder,
                                 const std::vector<std::string>& extensions) {
  std::vector<std::string> paths;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    if (hasExtension(entry.path(), extensions)) paths.push_back(entry.path().string());
  }
  if (failed) throw InputError(fmt::format("{}: cannot read: {}", folder, failed.message()));
  return paths;
}

}  // namespace

bool isSequence(const std::string& name) {
  std::error_code ignored;
  if (fs::is_directory(name, ignored)) return true;
  return name.find_first_of("*?[") != std::string::npos && !fs::exists(name, ignored);
}

bool hasExtension(const fs::path& path, const std::vector<std::string>& extensions) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(extensions, extension) != extensions.end();
}

std::vector<fs::path> filesOf(const std::vector<std::string>& names,
                              const std::vector<std::string>& extensions) {
  std::vector<fs::path> files;
  for (const std::string& name : names) {
    if (!isSequence(name)) {
      files.emplace_back(name);
      continue;
    }
    const bool folder = fs::is_directory(name);
    const auto found = folder ? filesIn(name, extensions) : matches(name);
    if (found.empty()) {
      throw InputError(folder ? fmt::format("{}: a folder without a file that can be imported ({})",
                                            name, fmt::join(extensions, ", "))
                              : fmt::format("{}: no file fits this pattern", name));
    }
    files.insert(files.end(), found.begin(), found.end());
  }
  // As versions are compared: numbers by their value.
  std::ranges::stable_sort(files, [](const fs::path& a, const fs::path& b) {
    return ::strverscmp(a.c_str(), b.c_str()) < 0;
  });
  return files;
}

std::string sequenceName(const std::vector<fs::path>& files) {
  std::string name = files.front().stem().string();
  while (files.size() > 1 && !name.empty() &&
         std::strchr("0123456789-_. ", name.back()) != nullptr) {
    name.pop_back();
  }
  for (char& c : name) {
    if (c < ' ' || c > '~' || c == '/') c = '_';
  }
  if (name.empty()) name = "frames";
  return name.substr(0, kLongestName);
}

}  // namespace broadmark::imports
