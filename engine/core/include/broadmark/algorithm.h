// How an algorithm is listed: everything that help, tables, command line and tests derive from.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "broadmark/broad_phase.h"

namespace broadmark {

/// How an algorithm takes part in worlds in which bodies come and go, or not all pairs are wanted.
enum class ChangingWorlds {
  /// Not at all: such worlds are not for it.
  unknown,
  /// Each frame may have another number of bodies, and is looked at as a whole: bodies that are
  /// absent are left out for it, and pairs that are not wanted are taken out of its answer.
  compacted,
  /// By itself.
  native
};

/// What holds for every instance of an algorithm: runs, lists and tests derive from it.
struct AlgorithmTraits {
  bool parallel = false;     ///< uses as many threads as it is given
  bool vectorised = false;   ///< heeds the instruction set
  bool on_device = false;    ///< runs on a compute device, whose driver starts threads itself
  bool incremental = false;  ///< keeps pairs or a structure from frame to frame
  bool events = false;       ///< knows by itself which pairs begin and end: BroadPhase::events()
  /// False for the self-checks, which report no pairs and are not checked for them.
  bool finds_pairs = true;
  /// A library that it calls allocates in a steady state; the algorithm cannot prevent that.
  bool library_allocates = false;
  /// A library that it calls keeps memory for every instance: no leak of the algorithm's.
  bool library_leaks = false;
  /// What it makes of bodies that are absent, and of pairs that are not wanted.
  ChangingWorlds changing_worlds = ChangingWorlds::unknown;
  /// Each of several worlds at one place has an instance of its own, however small they are: for
  /// one that pays for bodies at the same place, whatever their worlds, or for those far away.
  /// Without it a `compacted` one has small worlds side by side in one instance, unless it is on a
  /// device, where that goes for all worlds; a `native` one gets all bodies as they are.
  bool instance_per_world = false;
  /// Small are worlds of fewer bodies than this: from here on instances of their own are quicker.
  std::size_t side_by_side_below = 100;
  /// Largest number of bodies it can handle.
  std::uint64_t max_objects = std::numeric_limits<std::uint32_t>::max();
  /// The process-wide state that its calls depend on, as in exclusive_use.h; "": none. Between two
  /// calls others may have used it.
  std::string exclusive = {};
  /// Parameter values that select code which the default values hardly ever reach: tests run each
  /// configuration with these, too.
  ParameterValues rare_parameters = {};
};

/// What the paper's Table 1 tells of an algorithm, beyond its traits.
struct AlgorithmDescription {
  std::string principle;      ///< "brute force", "sorting", "grid", "tree"
  std::string optimisations;  ///< besides SIMD, threads and devices; "": none
  std::string time;           ///< complexity: "O(n²)"
  std::string space;          ///< "O(n + k)", k the number of pairs
  std::string source;         ///< paper and section, or library
};

/// A library that an algorithm comes from.
struct PluginBuild {
  std::string hash = {};     ///< of the file
  std::string flags = {};    ///< compiler and options, as far as it tells; "": it does not
  bool unoptimised = false;  ///< it says so
};

/// One algorithm variant.
struct Algorithm {
  std::string id;            ///< "sap-simd-mt"
  std::string family;        ///< "SAP"
  std::string summary = {};  ///< one sentence
  AlgorithmTraits traits = {};
  AlgorithmDescription description = {};
  /// A new instance with default parameters.
  std::function<std::unique_ptr<BroadPhase>()> create;
  std::string plugin = {};  ///< the file it was loaded from; "": built in
  PluginBuild plugin_build = {};
};

}  // namespace broadmark
