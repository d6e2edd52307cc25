// The results of a whole run, and the files that hold them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "broadmark/harness/case_result.h"
#include "broadmark/harness/environment.h"

namespace broadmark {

/// A whole run, or several that were merged.
struct Results {
  std::vector<Environment> environments;  ///< one, unless merged from several machines
  std::vector<std::string> options;       ///< the command line
  std::vector<CaseResult> cases;
  bool complete = false;  ///< the run came to its end
};

/// One way to write results. The list of all of them is resultWriters().
struct ResultWriter {
  std::string_view name;  ///< of the command line option, without dashes: "json"
  std::string_view doc;
  std::string (*format)(const Results&);
  /// Text that can be written as the run goes: what stands before and after the cases, and each
  /// case, `format` being all of them one after the other. Null where the whole must be written
  /// anew.
  struct Lines {
    std::string (*before)(const Results&);
    std::string (*one)(const CaseResult&);
    std::string (*after)(const Results&);
  };
  const Lines* lines = nullptr;
};
std::vector<ResultWriter> resultWriters();

/// The kind of JSON file, its "schema", that results are. docs/results.md describes it.
inline constexpr std::string_view kResultsSchema = "broadmark-results/2";
/// Whether a file of this schema can be parsed: of this version or an earlier one.
bool isResultsSchema(std::string_view schema);

/// Parses a results file, either one document or lines (JSON Lines). The last line may be broken:
/// the run ended while it was written. `name` stands for the file in messages. Throws InputError.
Results parseResults(std::string_view text, std::string_view name);

}  // namespace broadmark
