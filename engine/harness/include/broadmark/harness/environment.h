// The machine and the build of a measurement.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace broadmark {

struct Environment {
  std::string host;  ///< network host name; "" in files without it
  std::string cpu;
  int logical_cores = 0;  ///< usable by this process
  int physical_cores = 0;
  std::vector<std::string> caches;  ///< "L1 Data 48K" … of the first core
  std::string isa;                  ///< the widest usable instruction set
  std::uint64_t memory_bytes = 0;
  std::string governor;     ///< CPU frequency governor; "" if unknown
  double load_average = 0;  ///< over the last minute
  std::string os;
  std::string compiler;
  std::string compiler_flags;
  std::string build_type;
  std::string version;      ///< Broadmark's
  std::string commit;       ///< 40 digits; "" if unknown
  std::string commit_date;  ///< ISO 8601; "" if unknown
  bool dirty = false;       ///< the commit's sources had other changes
  std::string started;      ///< UTC, ISO 8601
  /// OpenCL devices, a line each; the first is the default. Filled in by the caller: engine does
  /// not depend on OpenCL.
  std::vector<std::string> compute_devices;

  friend bool operator==(const Environment&, const Environment&) = default;
};

Environment thisEnvironment();

/// "1a2b3c4d5e with changes": the commit, abbreviated; "unknown".
std::string commitName(const Environment&);

/// The version, the commit, the compiler and its options.
std::string buildName(const Environment&);

}  // namespace broadmark
