// The files of a sequence: which ones a name stands for, and what the sequence is called.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace broadmark::imports {

/// Whether a name stands for several files: a folder, or a pattern with '*', '?' or '[' in it.
bool isSequence(const std::string& name);

/// The files that names stand for, in natural order: frame10 after frame9. Of a folder those with
/// one of the `extensions`. Throws InputError when a name stands for none.
std::vector<std::filesystem::path> filesOf(const std::vector<std::string>& names,
                                           const std::vector<std::string>& extensions);

/// What these files are called together: the first one's name without its number, as a recording
/// can hold it.
std::string sequenceName(const std::vector<std::filesystem::path>& files);

/// Whether `path` has one of the extensions, in upper or lower case.
bool hasExtension(const std::filesystem::path& path, const std::vector<std::string>& extensions);

}  // namespace broadmark::imports
