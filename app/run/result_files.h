// The files that a run keeps its results in.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/files.h"
#include "broadmark/results/results.h"
#include "request/run_request.h"

namespace broadmark {

/// Writes whole results to each of the paths, unless there is no case.
void writeResults(const ResultPaths& paths, const Results& results);

/// Keeps files of results up to date while a run goes on. Those made of lines get each case as soon
/// as it is done, on the disc; the others are replaced atomically when a recording
/// is done, or, to standard output, once at the end. Without any case all files stay as they were.
/// Every method throws InputError when a file cannot be written.
class ResultFiles {
 public:
  /// Takes the files of lines for itself; `results` has no cases yet. Paths as writeOutput() takes
  /// them.
  ResultFiles(const ResultPaths& paths, const Results& results);

  void add(const CaseResult& result);
  /// Writes the other files.
  void rewrite(const Results& results);
  void end(const Results& results);

 private:
  struct Lines {
    const ResultWriter::Lines* writer;
    std::unique_ptr<AppendedFile> file;
    std::string before;  ///< what stands before the first case, until that is written
  };
  void write(const Results& results, bool to_standard_output);

  std::vector<Lines> lines_;
  std::vector<std::pair<ResultWriter, std::filesystem::path>> wholes_;
};

}  // namespace broadmark
