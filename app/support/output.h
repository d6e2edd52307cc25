// Output of a command's results, to a file or to standard output.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace broadmark {

/// Whether the path of an output file means standard output: "-" or /dev/stdout. Commands then
/// print nothing else to it.
bool isStandardOutput(const std::filesystem::path&);

/// Output files by the names of their options.
using OutputPaths = std::map<std::string, std::filesystem::path>;
/// Whether any of them is standard output.
bool useStandardOutput(const OutputPaths&);

/// Throws InputError if the path is not writable, to fail before long work.
void requireOutput(const std::filesystem::path&);

/// The output files of a command.
class OutputFiles {
 public:
  /// Adds a file that must not be overwritten. Does nothing for "".
  void addSource(const std::filesystem::path&);
  /// Throws InputError if the file of this option cannot be written, or would overwrite a source or
  /// another output, to fail before long work.
  void require(const std::string& option, const std::filesystem::path&);
  /// The same for each of these options.
  void require(const OutputPaths&);

 private:
  std::map<std::filesystem::path, std::string> used_by_;
};

/// Reads a file, or standard input for "-". Throws InputError.
std::string readInput(const std::filesystem::path&);

/// Number of columns of standard output: those of the variable COLUMNS, else of the terminal, else
/// 80.
std::size_t outputWidth();

/// Writes a text; to a file atomically. Throws InputError.
void writeOutput(const std::filesystem::path&, std::string_view text);

}  // namespace broadmark
