// Result files of a run.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/files.h"
#include "broadmark/results/results.h"
#include "request/run_request.h"

namespace broadmark {

/// Writes complete results to each of the paths, unless there are no cases.
void writeResults(const OutputPaths& paths, const Results& results);

/// Keeps result files up to date during a run. Line-based files get each case when it is finished,
/// synced to disc; the others are atomically replaced after each recording or, on standard output,
/// written once at the end. Without any case, all files remain unchanged. Every method throws
/// InputError if a file cannot be written.
class ResultFiles {
 public:
  /// Opens the line-based files; `results` has no cases yet. Paths are those of writeOutput().
  ResultFiles(const OutputPaths& paths, const Results& results);

  void add(const CaseResult& result);
  /// Replaces the files that are not line-based.
  void rewrite(const Results& results);
  void finish(const Results& results);

 private:
  struct LineFile {
    const ResultWriter::Lines* writer;
    std::unique_ptr<AppendedFile> file;
    std::string header;  ///< written before the first case; empty afterwards
  };
  void write(const Results& results, bool to_standard_output);

  std::vector<LineFile> line_files_;
  std::vector<std::pair<ResultWriter, std::filesystem::path>> whole_files_;
};

}  // namespace broadmark
