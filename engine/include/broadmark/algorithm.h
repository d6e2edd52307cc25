// How an algorithm is listed: everything that help, tables, command line and tests derive from.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/broad_phase.h"

namespace broadmark {

/// A name by which the original Broadmark calls an algorithm, and the instruction set it implies.
struct OriginalId {
  std::string name;
  std::optional<Isa> isa;
};

/// One algorithm variant.
struct Algorithm {
  std::string id;           ///< "sap-simd-mt"
  std::string family;       ///< "SAP"
  std::string summary;      ///< one sentence
  bool parallel = false;    ///< uses several threads
  bool vectorised = false;  ///< heeds the instruction set
  bool on_device = false;   ///< runs on a compute device, whose driver has threads of its own
  /// False for the self-checks, which report no pairs and are not checked for them.
  bool finds_pairs = true;
  std::vector<OriginalId> original_ids;
  std::function<std::unique_ptr<BroadPhase>()> create;
  /// A library beneath it allocates in a steady state, out of its reach.
  bool library_allocates = false;
  std::string plugin;  ///< the file it was loaded from; "": built in

  // The paper's Table 1.
  std::string principle;            ///< "brute force", "sorting", "grid", "tree"
  std::string optimisations;        ///< "SIMD, threads"
  bool incremental = false;         ///< keeps pairs from frame to frame
  std::string exactness = "exact";  ///< or what its margin is
  std::string time;                 ///< complexity: "O(n²)"
  std::string space;                ///< "O(n + k)", k the number of pairs
  std::string source;               ///< paper and section, or library
};

}  // namespace broadmark
