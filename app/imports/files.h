// The files of a sequence: which ones a name stands for, and what the sequence is called.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace broadmark::imports {

/// The files that a name stands for: itself; of a folder those with one of the `extensions`; or
/// those that fit, if it is a pattern with '*', '?' or '[' in it. In no order. Throws InputError
/// when a folder cannot be read.
std::vector<std::filesystem::path> filesNamed(const std::string& name,
                                              const std::vector<std::string>& extensions);

/// All files that these names stand for, in natural order: frame10 after frame9. Throws InputError
/// when a name stands for none, or for a file without one of the `extensions`.
std::vector<std::filesystem::path> filesOf(const std::vector<std::string>& names,
                                           const std::vector<std::string>& extensions);

/// What these files are called together: the first one's name without its number, as a recording
/// can hold it.
std::string sequenceName(const std::vector<std::filesystem::path>& files);

/// Whether `path` has one of the extensions, in upper or lower case.
bool hasExtension(const std::filesystem::path& path, const std::vector<std::string>& extensions);

}  // namespace broadmark::imports
