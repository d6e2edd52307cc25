// An algorithm's description, from which help, tables, command line and tests are derived.
//
// Example:
//
//   class MySweep final : public BoxBroadPhase {
//     void findPairs() override {}
//   };
//   const Algorithm mine = {.id = "my-sweep",
//                           .family = "MySweep",
//                           .summary = "sweep along the widest axis",
//                           .traits = {.changing_worlds = ChangingWorlds::compacted},
//                           .create = [] { return std::make_unique<MySweep>(); }};
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/broad_phase.h"

namespace broadmark {

/// Support for worlds in which bodies appear and disappear, or some pairs are unwanted.
enum class ChangingWorlds {
  /// No support: such worlds are skipped.
  unknown,
  /// Frames are independent and may differ in the number of bodies: an adapter removes absent
  /// bodies from the frames and unwanted pairs from the answers.
  compacted,
  /// Support by the algorithm itself.
  native
};

/// Properties of every instance of an algorithm: runs, lists and tests derive from them.
struct AlgorithmTraits {
  bool parallel = false;     ///< uses all threads it is given
  bool vectorised = false;   ///< has per-ISA kernels
  bool on_device = false;    ///< runs on a compute device, with a driver that starts threads
  bool incremental = false;  ///< retains pairs or a structure between frames
  bool events = false;       ///< reports begun and ended pairs: BroadPhase::events()
  /// The kinds of queries it answers: BroadPhase::searchQueries().
  std::vector<AnswerKind> queries = {};
  /// False for the self-checks, which report no pairs and are not checked for them.
  bool finds_pairs = true;
  /// A library called by the algorithm allocates in a steady state, unavoidably.
  bool library_allocates = false;
  /// A library called by the algorithm leaks memory for every instance.
  bool library_leaks = false;
  /// A library called by the algorithm ends the process when memory ends, instead of reporting it.
  bool library_aborts = false;
  /// Treatment of absent bodies and of unwanted pairs.
  ChangingWorlds changing_worlds = ChangingWorlds::unknown;
  /// Each of several worlds at the same place has its own instance, however small: for algorithms
  /// with a cost for bodies of other worlds at the same place, or for distant bodies. Without it a
  /// `compacted` algorithm gets small worlds side by side in one instance (on a device, all
  /// worlds); a `native` one gets all bodies unmoved.
  bool instance_per_world = false;
  /// Worlds with fewer bodies than this are small; for larger ones separate instances are faster.
  std::size_t side_by_side_below = 100;
  /// Largest number of bodies supported.
  std::uint64_t max_objects = std::numeric_limits<std::uint32_t>::max();
  /// The process-wide state that calls depend on, as in exclusive_use.h; "": none. Other code
  /// may use it between two calls.
  std::string exclusive = {};
  /// Its times are those that an external program reports; its memory is not known.
  bool self_timed = false;
  /// Sets of parameter values for code that the default values hardly ever reach: tests run each
  /// configuration with each of them, too.
  std::vector<ParameterValues> rare_parameters = {};
};

/// A row of the paper's Table 1, beyond the traits.
struct AlgorithmDescription {
  std::string principle;      ///< "brute force", "sorting", "grid", "tree"
  std::string optimisations;  ///< besides SIMD, threads and devices; "": none
  std::string time;           ///< complexity: "O(n²)"
  std::string space;          ///< "O(n + k)" for k pairs
  std::string source;         ///< paper and section, or library
};

/// How the library that an algorithm comes from was built.
struct PluginBuild {
  std::string hash = {};     ///< of the file
  std::string flags = {};    ///< compiler and options; "": not reported
  bool unoptimised = false;  ///< if reported
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
  std::string plugin = {};  ///< the plug-in's file; "": built in
  PluginBuild plugin_build = {};
};

}  // namespace broadmark
