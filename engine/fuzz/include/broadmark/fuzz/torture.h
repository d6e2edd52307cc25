// Torture: fuzzing of algorithms on random worlds against the oracle.
//
// A round runs one random case: an algorithm, its parameters, instruction set, threads and kind of
// answer. It runs many small worlds, one after the other in the same executor, some of them twice:
// unchanged, or with the bodies in another order. Some rounds end with a world of many bodies or
// frames. A fault is shrunk, and its case simplified. A round depends only on seed and number, so
// any round can be repeated, in any order.
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

enum class FaultKind {
  wrong_answer,
  invariant_violation,  ///< BroadPhase::validate() reports a violation
  failure,              ///< an exception, or the end of the process
  hang,                 ///< no answer within the executor's limit
  leak,                 ///< each pass allocates memory without freeing it
  nondeterministic      ///< not reproducible on the same world
};
inline constexpr NameTable kFaultKinds{{NamedValue{FaultKind::wrong_answer, "wrong answer"},
                                        {FaultKind::invariant_violation, "broken invariant"},
                                        {FaultKind::failure, "failure"},
                                        {FaultKind::hang, "hang"},
                                        {FaultKind::leak, "leak"},
                                        {FaultKind::nondeterministic, "nondeterministic"}}};

struct Fault {
  FaultKind kind = FaultKind::wrong_answer;
  std::uint32_t frame = 0;                   ///< the frame of detection; for a leak the last one
  std::string text;                          ///< "1 missed, 0 false, 0 invalid"
  std::vector<std::uint32_t> suspects = {};  ///< bodies of the wrong pair, if any
};

/// A fault, and the smallest reproducer found.
struct TortureFinding {
  Case test_case;
  std::string world;  ///< its generator: "touching"
  Fault fault;        ///< on the part; if nondeterministic, on the world
  std::unique_ptr<IndexedFrames> frames;
  Selection part;        ///< the selected bodies and frames
  bool minimal = false;  ///< as ShrunkPart::minimal
};

/// A tested combination of settings.
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
  std::uint64_t changing = 0;        ///< number of frames in which bodies may appear or disappear
  std::uint64_t filtered = 0;        ///< number of frames with unwanted pairs
  std::uint64_t filter_changes = 0;  ///< number of frames in which filters may change
  std::uint64_t max_bodies = 0;      ///< of a world
  std::uint64_t max_frames = 0;      ///< of a world

  TortureCount& operator+=(const TortureCount&);
};
using TortureCoverage = std::map<TortureKey, TortureCount>;

struct TortureRecording {
  SceneInfo scene;
  std::vector<std::vector<Aabb>> frames;
  std::vector<CollisionFilter> filters = {};  ///< by frame, if scene.filter_changes
};

struct TortureOptions {
  std::vector<Algorithm> algorithms;   ///< not empty unless only_case is set
  std::optional<Case> only_case = {};  ///< used in all rounds
  std::uint64_t seed = 1;
  ExecutorFactory make_executor = makeInProcessExecutor;
  std::vector<TortureRecording> given = {};  ///< excerpts serve as worlds, too: "given"
  bool only_given = false;                   ///< requires a given recording
  double max_shrink_seconds = 30;            ///< per fault; afterwards the best part is reported
  /// The executor is this process, and these rounds are its only work: its heap tells leaks.
  bool own_process = false;
  std::function<void()> on_world = {};  ///< called before each world of a round
  /// Returns whether to shrink another such fault of that algorithm; empty: always. Called
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

/// A fault that a round had elsewhere, beside other rounds in a process, in its world number
/// `world`.
struct SuspectedFault {
  Fault fault;
  std::size_t world = 0;
};

/// Runs a round. Does not count unsupported cases (a device, a number of bodies). A round without
/// a fault that had a suspected one has that as a nondeterministic one. Throws Cancelled, without
/// any effect.
TortureRound runTortureRound(const TortureOptions&, std::uint64_t number,
                             const std::optional<SuspectedFault>& suspected = {});

/// Returns the first fault of a case on a recording; with `leak`, also tries whether it leaks.
std::optional<Fault> findFault(const Case&, IndexedFrames&, const TortureOptions&, bool leak);

}  // namespace broadmark
