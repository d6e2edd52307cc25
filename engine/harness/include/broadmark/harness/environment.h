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
  std::string version;  ///< Broadmark's
  std::string started;  ///< UTC, ISO 8601
  /// OpenCL devices, a line each; the first is the default. Filled in by the caller: engine does
  /// not depend on OpenCL.
  std::vector<std::string> compute_devices;

  friend bool operator==(const Environment&, const Environment&) = default;
};

Environment thisEnvironment();

}  // namespace broadmark
