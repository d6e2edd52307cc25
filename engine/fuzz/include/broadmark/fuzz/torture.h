// Torture: algorithms in random ways on random worlds, until one of them does something wrong.
//
// A round is one case, drawn at random: an algorithm, its parameters, instruction set, threads and
// kind of answer. It runs on many small worlds, one after the other in the same host, some of them
// twice: once more, or with the bodies in another order. What goes wrong is shrunk. A round follows
// from seed and number alone, so that any of them can be run again, in any order.
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

/// What can go wrong.
enum class FaultKind {
  wrong_answer,
  unsound,  ///< BroadPhase::validate() finds fault
  failure,  ///< an exception, or the end of the process
  hang,     ///< no answer within the host's limit
  leak,     ///< each pass takes memory that it does not give back
  unsteady  ///< any of these, but not again on the same world
};
inline constexpr NameTable kFaultKinds{{NamedValue{FaultKind::wrong_answer, "wrong answer"},
                                        {FaultKind::unsound, "broken invariant"},
                                        {FaultKind::failure, "failure"},
                                        {FaultKind::hang, "hang"},
                                        {FaultKind::leak, "leak"},
                                        {FaultKind::unsteady, "unsteady"}}};

struct Fault {
  FaultKind kind = FaultKind::wrong_answer;
  std::uint32_t frame = 0;                   ///< in which it showed; of a leak the last one
  std::string text;                          ///< "1 missed, 0 false, 0 invalid"
  std::vector<std::uint32_t> suspects = {};  ///< bodies of a pair that is wrong, if one is
};

/// A fault, and the smallest recording that was found to show it.
struct TortureFinding {
  Case run;
  std::string world;  ///< what it was made as: "touching"
  Fault fault;        ///< on the part; of an unsteady one on the world
  std::unique_ptr<IndexedFrames> frames;
  Part part;             ///< of these frames
  bool minimal = false;  ///< as ShrunkPart::minimal
};

/// What has been run.
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
  std::uint64_t changing = 0;  ///< of the frames those in which bodies may come and go
  std::uint64_t filtered = 0;  ///< likewise: not all pairs are wanted

  TortureCount& operator+=(const TortureCount&);
};
using TortureCoverage = std::map<TortureKey, TortureCount>;

/// A recording in memory.
struct TortureRecording {
  SceneInfo scene;
  std::vector<std::vector<Aabb>> frames;
};

struct TortureOptions {
  std::vector<Algorithm> algorithms;   ///< one at least, unless there is a case
  std::optional<Case> only_case = {};  ///< which is run in all rounds
  std::uint64_t seed = 1;
  ExecutorFactory make_host = makeLocalHost;
  std::vector<TortureRecording> given = {};  ///< small parts of them are worlds, too: "given"
  bool only_given = false;                   ///< there is one at least
  double most_shrink_seconds = 30;           ///< for a fault; then the best part so far is it
  /// Whether another such fault of that algorithm is worth shrinking; empty: always. May be called
  /// by several threads.
  std::function<bool(const std::string& algorithm, FaultKind)> is_news = {};
  CancelQuery cancelled = {};
};

/// The names of all kinds of worlds, "given" aside.
std::vector<std::string> tortureWorlds();

struct TortureRound {
  TortureCoverage coverage;
  std::optional<TortureFinding> finding;  ///< which ended the round
};

/// Runs one round. What cannot run here (a device, a number of bodies) counts for nothing. Throws
/// Cancelled; then nothing of the round counts.
TortureRound runTortureRound(const TortureOptions&, std::uint64_t number);

}  // namespace broadmark
