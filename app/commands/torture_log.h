// Log of a torture, from which it can be resumed.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/fuzz/torture.h"
#include "broadmark/json_fields.h"

namespace broadmark {

/// A fault with a written reproducer.
struct FoundFault {
  std::string algorithm;
  std::string kind;       ///< as in kFaultKinds
  std::string test_case;  ///< as caseName()
  std::string world;
  std::string text;
  std::uint64_t round = 0;
  std::string file;
  std::size_t bodies = 0;
  std::size_t frames = 0;  ///< the initial pose not counted
  bool minimal = false;
  std::string boxes;    ///< lines with the boxes and the wrong pair of a few bodies; "": too many
  std::string command;  ///< reproduces the fault
};

/// The algorithm and the kind of a fault.
using FaultName = std::pair<std::string, std::string>;

/// "broadmark-torture/1"
struct TortureLog {
  std::uint64_t seed = 1;
  std::vector<std::string> subjects;      ///< ids of algorithms, or the one case
  std::vector<std::string> builds;        ///< hashes of their plug-ins
  std::uint64_t next = 0;                 ///< first round that has not started
  std::vector<std::uint64_t> unfinished;  ///< rounds before `next` that have not finished
  double seconds = 0;
  TortureCoverage coverage;
  std::vector<FoundFault> found;
  /// Number of faults per algorithm and kind of fault, including those without a reproducer.
  std::map<FaultName, std::uint64_t> times;

  [[nodiscard]] std::uint64_t frames() const;
};

/// Parses and formats a log file. Throws InputError, calling the file `name`.
TortureLog parseTortureLog(std::string_view text, const std::string& name);
std::string tortureLogText(const TortureLog&);

/// A coverage as the log's list, and back from the object that contains it.
Json toJson(const TortureCoverage&);
TortureCoverage coverageFrom(const JsonFields&);

/// Formats a fault and the size of its reproducer on one line.
std::string formatFoundFault(const FoundFault&);
/// Formats the coverage, one algorithm per row, and the faults found.
std::string formatTortureLog(const TortureLog&);

}  // namespace broadmark
