// Files and names of sequences.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace broadmark::imports {

/// Returns the files that a name refers to, in no order: the file itself; the files of a folder
/// with one of the `extensions`; or the matches of a pattern with '*', '?' or '['. Throws
/// InputError if a folder cannot be read.
std::vector<std::filesystem::path> expandName(const std::string& name,
                                              const std::vector<std::string>& extensions);

/// Returns all files that these names refer to, in natural order: frame10 after frame9. Throws
/// InputError for a name without files, or a file without one of the `extensions`.
std::vector<std::filesystem::path> expandNames(const std::vector<std::string>& names,
                                               const std::vector<std::string>& extensions);

/// Name of a sequence, valid for recordings: the first file's name without its number.
std::string sequenceName(const std::vector<std::filesystem::path>& files);

/// Whether `path` has one of the extensions, ignoring case.
bool hasExtension(const std::filesystem::path& path, const std::vector<std::string>& extensions);

}  // namespace broadmark::imports
