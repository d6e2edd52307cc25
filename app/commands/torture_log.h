// What a torture has done so far, in a file with which it goes on.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/fuzz/torture.h"

namespace broadmark {

/// A finding that has been written.
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
  std::string command;  ///< that shows it
};

/// "broadmark-torture/1"
struct TortureLog {
  std::uint64_t seed = 1;
  std::vector<std::string> subjects;  ///< ids of algorithms, or the one case
  std::vector<std::string> builds;    ///< hashes of their plug-ins
  std::uint64_t next = 0;             ///< the first round that has not been begun
  std::vector<std::uint64_t> left;    ///< rounds before that which are not finished
  double seconds = 0;
  TortureCoverage coverage;
  std::vector<FoundFault> found;
  /// Of an algorithm and a kind of fault: how often it was found. Only the first few are written.
  std::map<std::pair<std::string, std::string>, std::uint64_t> times;

  [[nodiscard]] std::uint64_t frames() const;
};

/// From the text of such a file, and back. Throws InputError, which calls it `name`.
TortureLog parseTortureLog(std::string_view text, const std::string& name);
std::string tortureLogText(const TortureLog&);

/// A finding in one line: what went wrong, and on how much.
std::string formatFoundFault(const FoundFault&);
/// What has been covered, an algorithm a row; and what was found.
std::string formatTortureLog(const TortureLog&);

}  // namespace broadmark
