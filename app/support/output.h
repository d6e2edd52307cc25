// Where a command writes its results: a file, or standard output.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace broadmark {

/// Whether a path given for a file means standard output: "-" or /dev/stdout. Then nothing else is
/// printed there.
bool isStandardOutput(const std::filesystem::path&);

/// Throws InputError if nothing can be written there: to fail now rather than after long work.
void requireOutput(const std::filesystem::path&);

/// The text of a file, or of standard input for "-". Throws InputError.
std::string readInput(const std::filesystem::path&);

/// Writes a whole text; a file atomically. Throws InputError.
void writeOutput(const std::filesystem::path&, std::string_view text);

}  // namespace broadmark
