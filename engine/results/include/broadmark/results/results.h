// The results of a whole run, and the files that hold them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "broadmark/harness/case_result.h"
#include "broadmark/harness/environment.h"

namespace broadmark {

/// A whole run, or several merged runs.
struct Results {
  std::vector<Environment> environments;  ///< one, unless merged from several machines
  std::vector<std::string> options;       ///< the command line
  std::vector<CaseResult> cases;
  bool complete = false;  ///< the run was not interrupted
};

/// An output format. resultWriters() lists all formats.
struct ResultWriter {
  std::string_view name;  ///< the command line option, without dashes: "json"
  std::string_view doc;
  std::string (*format)(const Results&);
  /// Functions to write text during a run: the parts before and after the cases, and each
  /// case; `format` concatenates them. Null if the whole text must be rewritten.
  struct Lines {
    std::string (*before)(const Results&);
    std::string (*one)(const CaseResult&);
    std::string (*after)(const Results&);
  };
  const Lines* lines = nullptr;
};
std::vector<ResultWriter> resultWriters();

/// The "schema" of JSON results. docs/results.md describes it.
inline constexpr std::string_view kResultsSchema = "broadmark-results/2";
/// Whether a file of this schema can be parsed: this version or an earlier one.
bool isResultsSchema(std::string_view schema);

/// Parses a results file, either one document or lines (JSON Lines). The last line may be
/// incomplete, from an interrupted run. `name` is used in messages. Throws InputError.
Results parseResults(std::string_view text, std::string_view name);

}  // namespace broadmark
