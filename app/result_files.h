// The files that a run keeps its results in.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "broadmark/files.h"
#include "broadmark/results.h"

namespace broadmark {

/// Where the results of a run go, by the name of the result writer.
using ResultPaths = std::map<std::string, std::filesystem::path>;

/// Keeps files of results up to date while a run goes on. Those made of lines get each case as soon
/// as it is done; the others are written anew, each time atomically, when a recording is done, or,
/// to standard output, once at the end. Every method throws InputError when a file cannot be
/// written.
class ResultFiles {
 public:
  /// Begins the files of lines; `results` has no cases yet. Paths as writeOutput() takes them.
  ResultFiles(const ResultPaths& paths, const Results& results);

  void add(const CaseResult& result);
  /// Writes the other files.
  void rewrite(const Results& results);
  /// Leaves the other files alone if there is no case: what they held may be wanted.
  void end(const Results& results);

 private:
  struct Lines {
    const ResultWriter::Lines* writer;
    std::filesystem::path path;
    FileDescriptor file;
  };
  static void append(const Lines& lines, const std::string& text);
  void write(const Results& results, bool to_standard_output);

  std::vector<Lines> lines_;
  std::vector<std::pair<ResultWriter, std::filesystem::path>> wholes_;
};

}  // namespace broadmark
