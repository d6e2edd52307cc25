// Torture: fuzzing of algorithms on random worlds against the oracle.
//
// A round is one random case: an algorithm, its parameters, instruction set, threads and kind of
// answer. It runs on many small worlds, one after the other in the same host, some of them twice:
// unchanged, or with the bodies in another order. A fault is shrunk. A round depends only on seed
// and number, so that any round can be repeated, in any order.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/harness/case_executor.h"
#include "broadmark/recordings/sub_recording.h"

namespace broadmark {

/// Kinds of faults.
enum class FaultKind {
  wrong_answer,
  unsound,  ///< BroadPhase::validate() reports a violation
  failure,  ///< an exception, or the end of the process
  hang,     ///< no answer within the host's limit
  leak,     ///< each pass allocates memory without freeing it
  unsteady  ///< not reproducible on the same world
};
inline constexpr NameTable kFaultKinds{{NamedValue{FaultKind::wrong_answer, "wrong answer"},
                                        {FaultKind::unsound, "broken invariant"},
                                        {FaultKind::failure, "failure"},
                                        {FaultKind::hang, "hang"},
                                        {FaultKind::leak, "leak"},
                                        {FaultKind::unsteady, "unsteady"}}};

struct Fault {
  FaultKind kind = FaultKind::wrong_answer;
  std::uint32_t frame = 0;                   ///< where it was detected; for a leak the last one
  std::string text;                          ///< "1 missed, 0 false, 0 invalid"
  std::vector<std::uint32_t> suspects = {};  ///< bodies of the wrong pair, if any
};

/// A fault, and the smallest recording found that shows it.
struct TortureFinding {
  Case test_case;
  std::string world;  ///< its generator: "touching"
  Fault fault;        ///< on the part; if unsteady on the world
  std::unique_ptr<IndexedFrames> frames;
  Part part;             ///< selects from these frames
  bool minimal = false;  ///< as ShrunkPart::minimal
};

/// A combination of settings that was run.
struct TortureKey {
  std::string algorithm;
  std::string isa;
  int threads = 1;
  std::string answer;
  std::string world;

  auto operator<=>(const TortureKey&) const = default;
};
struct TortureCount {
  std::uint64_t worlds = 0;
  std::uint64_t frames = 0;
  std::uint64_t changing = 0;  ///< number of frames in which bodies may appear or disappear
  std::uint64_t filtered = 0;  ///< number of frames with unwanted pairs

  TortureCount& operator+=(const TortureCount&);
};
using TortureCoverage = std::map<TortureKey, TortureCount>;

/// A recording in memory.
struct TortureRecording {
  SceneInfo scene;
  std::vector<std::vector<Aabb>> frames;
};

struct TortureOptions {
  std::vector<Algorithm> algorithms;   ///< not empty unless only_case is set
  std::optional<Case> only_case = {};  ///< used in all rounds
  std::uint64_t seed = 1;
  ExecutorFactory make_host = makeLocalHost;
  std::vector<TortureRecording> given = {};  ///< small parts of them serve as worlds, too: "given"
  bool only_given = false;                   ///< requires a given recording
  double max_shrink_seconds = 30;            ///< per fault; then the best part so far is reported
  /// Whether another such fault of that algorithm is worth shrinking; empty: always. Called
  /// concurrently.
  std::function<bool(const std::string& algorithm, FaultKind)> is_news = {};
  CancelQuery cancelled = {};
};

/// The names of all kinds of worlds, except "given".
std::vector<std::string> tortureWorlds();

struct TortureRound {
  TortureCoverage coverage;
  std::optional<TortureFinding> finding;  ///< the fault that ended the round
};

/// Runs one round. Unsupported cases (a device, a number of bodies) are not counted. Throws
/// Cancelled; then the round has no effect.
TortureRound runTortureRound(const TortureOptions&, std::uint64_t number);

}  // namespace broadmark
