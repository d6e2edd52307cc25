// Files and names of sequences.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace broadmark::imports {

/// Returns the files that a name refers to, in no order: the file itself; the files of a folder
/// that are not hidden; or the matches of a pattern with '*', '?' or '[', below folders that may
/// have these characters in their names. Throws InputError if a folder cannot be read.
std::vector<std::filesystem::path> expandName(const std::string& name);

/// Sorts files in natural order: frame10 after frame9.
void sortNaturally(std::vector<std::filesystem::path>& files);

/// Name of a sequence, valid for recordings: the first file's name without its number.
std::string sequenceName(const std::vector<std::filesystem::path>& files);

/// Whether `path` has one of the extensions, ignoring case, and one for compression.
bool hasExtension(const std::filesystem::path& path, const std::vector<std::string>& extensions);

}  // namespace broadmark::imports
