#include "imports/files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glob.h>
#include <strings.h>

#include <algorithm>
#include <cstring>

#include "broadmark/error.h"
#include "broadmark/frame.h"

namespace broadmark::imports {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> matchingFiles(const std::string& pattern) {
  glob_t found{};
  std::vector<fs::path> files;
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
  return files;
}

std::vector<fs::path> filesIn(const std::string& folder,
                              const std::vector<std::string>& extensions) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    if (hasExtension(entry.path(), extensions)) files.push_back(entry.path());
  }
  if (failed) throw InputError(fmt::format("{}: cannot read: {}", folder, failed.message()));
  return files;
}

}  // namespace

bool hasExtension(const fs::path& path, const std::vector<std::string>& extensions) {
  const std::string actual = path.extension().string();
  return std::ranges::any_of(extensions, [&](const std::string& extension) {
    return ::strcasecmp(extension.c_str(), actual.c_str()) == 0;
  });
}

std::vector<fs::path> expandName(const std::string& name,
                                 const std::vector<std::string>& extensions) {
  std::error_code ignored;
  if (fs::is_directory(name, ignored)) return filesIn(name, extensions);
  if (name.find_first_of("*?[") != std::string::npos && !fs::exists(name, ignored)) {
    return matchingFiles(name);
  }
  return {name};
}

std::vector<fs::path> expandNames(const std::vector<std::string>& names,
                                  const std::vector<std::string>& extensions) {
  std::vector<fs::path> files;
  for (const std::string& name : names) {
    const auto expanded = expandName(name, extensions);
    if (expanded.empty()) {
      throw InputError(
          fmt::format("{}: matches no file; expected: {}", name, fmt::join(extensions, ", ")));
    }
    files.insert(files.end(), expanded.begin(), expanded.end());
  }
  for (const fs::path& file : files) {
    if (hasExtension(file, extensions)) continue;
    throw InputError(fmt::format("{}: not the same kind of file as the first: {} is expected",
                                 file.string(), fmt::join(extensions, ", ")));
  }
  // Natural order: numbers are compared by value.
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
  return name.substr(0, kMaxNameLength);
}

}  // namespace broadmark::imports
