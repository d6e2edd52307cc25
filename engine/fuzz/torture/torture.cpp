#include "broadmark/fuzz/torture.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/fuzz/shrink.h"
#include "delta_debugging.h"
#include "torture/random_world.h"
#include "torture/trial.h"

namespace broadmark {
namespace {

using inputs::Random;

/// Small worlds per round. Drivers of devices compile kernels for each, which takes fifty times as
/// long.
constexpr std::size_t kWorlds = 40;
constexpr std::size_t kDeviceWorlds = 3;
/// Frames of a long world.
constexpr std::uint32_t kFrames = 300;
constexpr std::uint32_t kDeviceFrames = 60;

constexpr const char* kNotWhenRerun = ", but not when rerun";

/// Log-uniform above `min`; sometimes one of the limits.
double randomValue(Random& random, double min, double max) {
  const int choice = random.integer(0, 9);
  if (choice == 0) return min;
  if (choice == 1) return max;
  const double share = static_cast<double>(random.uniform(0, 1));
  return std::min(max, min + std::expm1(share * std::log1p(max - min)));
}

void randomize(Random& random, const Parameter& parameter) {
  if (const auto* value = std::get_if<bool*>(&parameter.value)) **value = random.onceIn(2);
  if (const auto* value = std::get_if<std::int64_t*>(&parameter.value)) {
    **value = static_cast<std::int64_t>(randomValue(random, parameter.min, parameter.max));
  }
  if (const auto* value = std::get_if<double*>(&parameter.value)) {
    **value = randomValue(random, parameter.min, parameter.max);
  }
  if (const auto* value = std::get_if<Choice*>(&parameter.value)) {
    (*value)->value = random.anyOf((*value)->options);
  }
}

/// The defaults half of the time, and often those for code that is seldom reached.
ParameterValues randomParameters(Random& random, const Algorithm& algorithm) {
  if (random.onceIn(2)) return {};
  const std::vector<ParameterValues>& rare = algorithm.traits.rare_parameters;
  if (!rare.empty() && random.onceIn(2)) return random.anyOf(rare);
  const std::unique_ptr<BroadPhase> instance = algorithm.create();
  instance->visitParameters([&](const Parameter& parameter) {
    if (random.onceIn(2)) randomize(random, parameter);
  });
  return changedValues(parameterValues(*instance), *algorithm.create());
}

/// Algorithms on a device a third as often as others: their rounds take four times as long.
const Algorithm& randomAlgorithm(Random& random, const std::vector<Algorithm>& algorithms) {
  const Algorithm& first = random.anyOf(algorithms);
  return first.traits.on_device && !random.onceIn(3) ? random.anyOf(algorithms) : first;
}

Case randomCase(Random& random, const std::vector<Algorithm>& algorithms) {
  constexpr std::array kThreads = {1, 2, 3, 5};
  const Algorithm& algorithm = randomAlgorithm(random, algorithms);
  const Isa isa = random.anyOf(supportedIsas());
  const int threads = random.anyOf(kThreads);
  Answer answer = random.anyOf(kAnswerKinds.entries).value;
  const std::vector<AnswerKind>& queries = algorithm.traits.queries;
  if (!queries.empty() && random.onceIn(4)) {
    answer = {random.anyOf(queries), static_cast<std::uint32_t>(random.integer(1, 40))};
  }
  return makeCase(algorithm, isa, threads, "", randomParameters(random, algorithm), answer);
}

class Round {
 public:
  Round(const TortureOptions& options, std::uint64_t number)
      : options_(options),
        random_(options.seed, static_cast<std::uint32_t>(number)),
        case_(options.only_case ? *options.only_case : randomCase(random_, options.algorithms)),
        is_exact_(makeInstance(case_)->margin() == 0),
        trial_(case_, options) {}

  TortureRound run(const std::optional<SuspectedFault>& suspected) {
    TortureRound round;
    RandomWorld suspect;
    const std::size_t count = case_.algorithm.traits.on_device ? kDeviceWorlds : kWorlds;
    for (std::size_t i = 0; i <= count; ++i) {
      if (options_.on_world) options_.on_world();
      RandomWorld world = i < count ? randomWorld(random_, options_) : extremeWorld();
      if (world.frames == nullptr) break;
      std::optional<Fault> fault = runOnce(world, round.coverage);
      if (!fault && i + 1 == count) fault = leak(*world.frames);
      if (fault) return makeFinding(std::move(round), std::move(world), *fault);
      if (suspected && suspected->world == i) suspect = std::move(world);
    }
    if (suspect.frames == nullptr) return round;
    Fault fault = suspected->fault;
    fault.kind = FaultKind::nondeterministic;
    fault.text += kNotWhenRerun;
    return makeFinding(std::move(round), std::move(suspect), fault);
  }

 private:
  /// Now and then a world of many bodies or frames; else none.
  RandomWorld extremeWorld() {
    if (options_.only_given || !random_.onceIn(8)) return {};
    // Other parameters, tests of all pairs and insertion sort may take minutes for many bodies.
    const std::string& time = case_.algorithm.description.time;
    const bool is_quick = case_.parameters.empty() && !time.starts_with("O(n²") &&
                          time.find("swaps") == std::string::npos;
    if (random_.onceIn(8) && is_quick) return largeWorld(random_);
    return longWorld(random_, case_.algorithm.traits.on_device ? kDeviceFrames : kFrames);
  }

  /// Detects a leak that is reproducible in a new process: caches of malloc and libraries vary.
  std::optional<Fault> leak(IndexedFrames& world) {
    const AlgorithmTraits& traits = case_.algorithm.traits;
    if (traits.library_leaks || traits.on_device || !trial_.leak(world)) return std::nullopt;
    return Trial(case_, options_).leak(world);
  }

  /// Runs a world, and repeats some of them.
  std::optional<Fault> runOnce(RandomWorld& world, TortureCoverage& coverage) {
    constexpr int kRepeatInterval = 8;
    // Exact answers must be equal both times.
    std::vector<PairDigest> first;
    std::vector<PairDigest> second;
    if (auto fault = trial_.run(*world.frames, is_exact_ ? nullptr : &first)) return fault;
    if (!trial_.supported()) return std::nullopt;
    count(world, coverage);
    if (random_.onceIn(kRepeatInterval)) {
      if (auto fault = trial_.run(*world.frames, is_exact_ ? nullptr : &second)) return fault;
      if (first != second)
        return Fault{FaultKind::nondeterministic, 0, "a different answer on the second pass"};
    }
    if (random_.onceIn(kRepeatInterval)) {
      world.frames = shuffled(random_, *world.frames);
      return trial_.run(*world.frames);
    }
    return std::nullopt;
  }

  void count(const RandomWorld& world, TortureCoverage& coverage) const {
    const SceneInfo& scene = world.frames->scene();
    coverage[{case_.algorithm.id, std::string(isaName(case_.isa)), case_.threads,
              isQuery(case_.answer) ? "queries" : answerName(case_.answer), world.name}] +=
        {.worlds = 1,
         .frames = scene.frames,
         .changing = scene.all_present ? 0 : scene.frames,
         .filtered = scene.filter.wantsAll() && !scene.filter_changes ? 0 : scene.frames,
         .filter_changes = scene.filter_changes ? scene.frames : 0,
         .max_bodies = scene.objects,
         .max_frames = scene.frames};
  }

  TortureRound makeFinding(TortureRound round, RandomWorld world, const Fault& fault) {
    round.finding = TortureFinding{.test_case = case_,
                                   .world = world.name,
                                   .fault = fault,
                                   .frames = std::move(world.frames),
                                   .part = {}};
    shrink(*round.finding);
    return round;
  }

  /// Returns the fault if these frames reproduce it in their last frame.
  std::optional<Fault> reproduce(Trial& trial, IndexedFrames& frames, FaultKind kind) const {
    auto fault = kind == FaultKind::leak ? trial.leak(frames) : trial.run(frames);
    if (!fault || fault->kind != kind) return std::nullopt;
    // A fault of the initial pose is reported as frame 1, as every recording has one.
    if (std::max(fault->frame, 1U) < frames.scene().frames) return std::nullopt;
    return fault;
  }

  /// Shrinks a fault, in a new process to exclude effects of earlier worlds.
  void shrink(TortureFinding& finding) const {
    const std::uint32_t last = finding.fault.kind == FaultKind::nondeterministic
                                   ? finding.frames->scene().frames
                                   : std::max(finding.fault.frame, 1U);
    finding.part = selectAll(finding.frames->scene(), last);
    if (finding.fault.kind == FaultKind::nondeterministic || !isWorthShrinking(finding.fault.kind))
      return;
    const FaultKind kind = finding.fault.kind;
    const CancelQuery is_late = deadlineQuery();
    simplifyCase(finding, is_late);
    Trial trial(finding.test_case, options_);
    const auto fails = [&](IndexedFrames& part) {
      const std::optional<Fault> fault = reproduce(trial, part, kind);
      if (fault) finding.fault = *fault;
      return fault.has_value();
    };
    const auto suspects = [&] { return finding.fault.suspects; };
    const ShrinkOptions limits{.progress = {}, .cancelled = is_late};
    try {
      const ShrunkPart shrunk =
          shrinkPart(*finding.frames, finding.part.frames.back(), suspects, fails, limits);
      finding.part = shrunk.part;
      finding.minimal = shrunk.minimal;
    } catch (const InputError&) {  // not reproducible
      finding.fault.text += kNotWhenRerun;
      finding.fault.kind = FaultKind::nondeterministic;
    }
  }

  /// Simplifies the settings while the fault recurs, at the latest in the part's last frame: pairs
  /// instead of events, one thread, default parameters.
  void simplifyCase(TortureFinding& finding, const CancelQuery& is_late) const {
    const auto still_fails = [&](const Case& simpler) {
      if (is_late()) return false;
      SubRecording frames(*finding.frames, finding.part, finding.world);
      const std::optional<Fault> fault =
          findFault(simpler, frames, options_, finding.fault.kind == FaultKind::leak);
      if (!fault || fault->kind != finding.fault.kind) return false;
      finding.test_case = simpler;
      finding.fault = *fault;
      finding.part = selectAll(finding.frames->scene(), std::max(fault->frame, 1U));
      return true;
    };
    if (case_.answer != AnswerKind::pairs) {
      Case simpler = finding.test_case;
      simpler.answer = AnswerKind::pairs;
      still_fails(simpler);
    }
    if (case_.threads > 1) {
      Case simpler = finding.test_case;
      simpler.threads = 1;
      still_fails(simpler);
    }
    const std::vector<std::pair<std::string, std::string>> parameters(case_.parameters.begin(),
                                                                      case_.parameters.end());
    minimize(parameters, 0, [&](const auto& fewer) {
      Case simpler = finding.test_case;
      simpler.parameters = {fewer.begin(), fewer.end()};
      return still_fails(simpler);
    });
  }

  [[nodiscard]] bool isWorthShrinking(FaultKind kind) const {
    return !options_.is_news || options_.is_news(case_.algorithm.id, kind);
  }

  [[nodiscard]] CancelQuery deadlineQuery() const {
    const auto end = std::chrono::steady_clock::now() +
                     std::chrono::duration<double>(options_.max_shrink_seconds);
    return [this, end] {
      return std::chrono::steady_clock::now() > end || (options_.cancelled && options_.cancelled());
    };
  }

  const TortureOptions& options_;
  Random random_;
  Case case_;
  bool is_exact_;
  Trial trial_;
};

}  // namespace

TortureCount& TortureCount::operator+=(const TortureCount& other) {
  worlds += other.worlds;
  frames += other.frames;
  changing += other.changing;
  filtered += other.filtered;
  filter_changes += other.filter_changes;
  max_bodies = std::max(max_bodies, other.max_bodies);
  max_frames = std::max(max_frames, other.max_frames);
  return *this;
}

TortureRound runTortureRound(const TortureOptions& options, std::uint64_t number,
                             const std::optional<SuspectedFault>& suspected) {
  return Round(options, number).run(suspected);
}

std::optional<Fault> findFault(const Case& test_case, IndexedFrames& frames,
                               const TortureOptions& options, bool leak) {
  Trial trial(test_case, options);
  std::optional<Fault> fault = trial.run(frames);
  return fault || !leak ? fault : trial.leak(frames);
}

}  // namespace broadmark
