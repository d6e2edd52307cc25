// broadmark advise: determines which algorithm, with which parameters, is fastest on a recording.
//
// For every answer and number of threads: all candidates run a few frames, and the slow ones are
// dropped; the others are halved in short duels; the parameters of the best candidates are varied,
// first each alone, then together; and the finalists fight a long duel. The cost of a candidate is
// that of the whole recording: the mean over the frames of their minimum times.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "broadmark/compute_devices.h"
#include "broadmark/error.h"
#include "broadmark/harness/runner.h"
#include "command_line/option_types.h"
#include "command_line/usage.h"
#include "commands/candidate_duels.h"
#include "commands/command.h"
#include "compare/advice.h"
#include "compare/comparison.h"
#include "request/plugins.h"
#include "run/plan.h"
#include "run/recordings.h"
#include "run/warnings.h"
#include "sources/make_source.h"
#include "support/clock.h"
#include "support/exit_status.h"
#include "support/interrupt.h"
#include "support/output.h"
#include "support/progress.h"
#include "support/words.h"

namespace broadmark::commands::advise {
namespace {

using Clock = std::chrono::steady_clock;

struct Options : RunRequest {
  std::string source;
  bool has_answer = false;  ///< only that answer
  std::string opening;      ///< the arguments that open the source
  double max_seconds = 120;
  bool quiet = false;
};

/// Which answer, on how many threads.
struct Contest {
  Answer answer;
  int threads = 1;
};

/// The mean size of the bodies that are present.
double meanExtent(const Frame& frame) {
  const std::vector<std::uint32_t> present = frame.presentBodies();
  double sum = 0;
  for (const std::uint32_t body : present) {
    for (int axis = 0; axis < 3; ++axis) {
      sum += frame.boxes[body].max[axis] - frame.boxes[body].min[axis];
    }
  }
  return present.empty() ? 0 : sum / (3 * static_cast<double>(present.size()));
}

class Adviser {
 public:
  Adviser(const Options& options, PlanEntry& entry, IndexedFrames& recording)
      : options_(options),
        cases_(entry.cases),
        id_(recordingId(entry.source.reference)),
        duels_(options.hosts, recording, [this](const std::string& what) { showProgress(what); }),
        body_extent_(meanExtent(recording.rewind())) {}

  int run() {
    std::vector<Contest> contests;
    for (const Answer answer : answers()) {
      for (const int threads : threadCounts()) contests.push_back({answer, threads});
    }
    std::erase_if(contests, [&](const Contest& contest) { return candidatesOf(contest).empty(); });
    if (contests.empty()) throw InputError("advise: no selected algorithm can run on this machine");
    printWarnings();
    std::size_t given = 0;
    try {
      Progress progress("advise", kTicks, options_.quiet);
      progress_ = &progress;
      for (const Contest& contest : contests) {
        const double left = options_.max_seconds - secondsSince(begin_);
        Advice advice = adviceOn(contest, left / static_cast<double>(contests.size() - given));
        progress.detail("");
        if (!useStandardOutput(options_.outputs)) {
          progress.print(adviceText(advice, options_.opening));
        }
        addToComparison(advice);
        ++given;
      }
      progress.update(kTicks);
    } catch (const Cancelled&) {
      if (given == 0) throw Interrupted();
      writeComparison(options_.outputs, comparison_);
      throw Interrupted(fmt::format("{} of {} given", given, counted(contests.size(), "answer")));
    }
    writeComparison(options_.outputs, comparison_);
    return duels_.hasFailures() ? exit_status::wrong_answer : exit_status::success;
  }

 private:
  static constexpr std::uint64_t kTicks = 1000;
  static constexpr std::size_t kTuned = 3;  ///< algorithms with varied parameters
  static constexpr int kTuningRounds = 2;
  /// Where memory lies differs between processes, and with it times, by up to this factor.
  static constexpr double kProcessDifference = 1.1;

  [[nodiscard]] std::vector<Answer> answers() const {
    if (options_.has_answer) return {options_.cases.answer};
    return {AnswerKind::pairs, AnswerKind::events};
  }

  [[nodiscard]] std::vector<int> threadCounts() const {
    std::set<int> threads(options_.cases.threads.begin(), options_.cases.threads.end());
    return {threads.begin(), threads.end()};
  }

  /// The cases for the contest's number of threads. On one thread, parallel variants equal others
  /// of their family.
  [[nodiscard]] std::vector<Candidate> candidatesOf(const Contest& contest) const {
    const auto is_parallel = [](const Case& test_case) {
      return test_case.algorithm.traits.parallel;
    };
    std::set<std::string> sequential;  // families
    for (const Case& test_case : cases_) {
      if (!is_parallel(test_case)) sequential.insert(test_case.algorithm.family);
    }
    std::vector<Candidate> candidates;
    for (Case test_case : cases_) {
      const AlgorithmTraits& traits = test_case.algorithm.traits;
      if (traits.on_device && (!has_device_ || contest.threads == 1)) continue;
      if (is_parallel(test_case) && test_case.threads != contest.threads) continue;
      if (is_parallel(test_case) && contest.threads == 1 &&
          sequential.contains(test_case.algorithm.family)) {
        continue;
      }
      if (traits.vectorised && !isaSupported(test_case.isa)) continue;
      test_case.answer = contest.answer;
      candidates.push_back({.test_case = std::move(test_case)});
    }
    return candidates;
  }

  void printWarnings() const {
    const Environment environment = thisEnvironment();
    RunWarnings warnings(environment);
    for (const Case& test_case : cases_) {
      if (!test_case.algorithm.traits.on_device) warnings.warningsFor(test_case);
    }
  }

  Advice adviceOn(const Contest& contest, double seconds) {
    const Clock::time_point begin = Clock::now();
    const auto left = [&] { return std::max(seconds - secondsSince(begin), 0.0); };
    tried_.clear();
    contest_name_ =
        fmt::format("{}, {}", answerName(contest.answer), counted(contest.threads, "thread"));
    std::vector<Candidate> candidates = candidatesOf(contest);
    const std::size_t tried = candidates.size();
    duels_.screen(candidates);
    const std::size_t duellists = candidates.size();

    const std::vector<std::size_t> best =
        halve(candidates.size(), kTuned, [&](const std::vector<std::size_t>& which) {
          std::vector<Candidate> sides;
          for (const std::size_t i : which) sides.push_back(candidates[i]);
          // Without time for a duel, the few frames decide.
          if (CandidateDuels::minSeconds(sides) <= left()) {
            return costsOf(duels_.measure(sides, left() / 6));
          }
          std::vector<double> costs;
          for (const Candidate& side : sides) costs.push_back(side.seconds);
          return costs;
        });
    std::vector<Candidate> tuned;
    for (const std::size_t i : best) tuned.push_back(candidates[i]);
    const std::vector<Candidate> defaults = tuned;
    std::size_t settings = 0;
    for (int round = 0; round < kTuningRounds; ++round) {
      for (Candidate& candidate : tuned) settings += tune(candidate, left() / (4 * kTuned));
    }
    Advice advice = judge(contest, tuned, defaults, std::max(left(), seconds / 4));
    advice.effort = fmt::format(
        "Tried {} on a few frames, the best {} in duels, and {} of parameters; the last duel ran "
        "on {}.",
        counted(tried, "algorithm"), duellists, counted(settings, "setting"), duels_.framesText());
    advice.wrong = duels_.takeFailures();
    return advice;
  }

  void showProgress(const std::string& detail) {
    if (!progress_->isDue()) return;
    progress_->detail(fmt::format("{}: {}", contest_name_, detail));
    const double left = std::max(options_.max_seconds - secondsSince(begin_), 0.0);
    const double share = std::min(1 - left / options_.max_seconds, 1.0);
    progress_->update(static_cast<std::uint64_t>(static_cast<double>(kTicks) * share), left);
  }

  static std::vector<double> costsOf(const std::vector<std::optional<CaseResult>>& results) {
    std::vector<double> costs;
    for (const auto& times : results) {
      costs.push_back(times ? costOf(*times) : std::numeric_limits<double>::infinity());
    }
    return costs;
  }

  /// Varies every parameter alone, unless the user has set it, and gives the candidate the values
  /// that made it faster. Returns the number of new variants; 0 if there is no time for them.
  std::size_t tune(Candidate& candidate, double seconds) {
    const ParameterValues& given = options_.parameters;
    std::vector<Candidate> sides = {candidate};
    std::vector<std::pair<std::string, std::string>> variants;  // parameter and value
    makeInstance(candidate.test_case)->visitParameters([&](const Parameter& parameter) {
      const std::string name(parameter.name);
      const std::string qualified = candidate.test_case.algorithm.id + ":" + name;
      if (given.contains(name) || given.contains(qualified)) return;
      for (const std::string& value : valuesAround(parameter, body_extent_)) {
        Candidate side = candidate;
        side.test_case.parameters[name] = value;
        if (!tried_.insert(nameOf(side)).second) continue;
        sides.push_back(std::move(side));
        variants.emplace_back(name, value);
      }
    });
    if (variants.empty() || CandidateDuels::minSeconds(sides) > seconds) return 0;
    const std::vector<std::optional<CaseResult>> results = duels_.measure(sides, seconds);
    const std::optional<CaseResult>& before = results.front();
    std::map<std::string, double> least_cost;  // by parameter
    for (std::size_t i = 0; before && i < variants.size(); ++i) {
      const auto& [parameter, value] = variants[i];
      const std::optional<CaseResult>& after = results[i + 1];
      if (!after) continue;
      double& least =
          least_cost.try_emplace(parameter, costOf(*before) / (1 + kAdviceMargin)).first->second;
      if (costOf(*after) >= least) continue;
      if (ratioWithinRun(*before, *after)->ratio.ci95.high >= 1) continue;
      least = costOf(*after);
      candidate.test_case.parameters[parameter] = value;
    }
    return variants.size();
  }

  /// The verdict on the last few, each tuned and with default parameters.
  Advice judge(const Contest& contest, const std::vector<Candidate>& tuned,
               const std::vector<Candidate>& defaults, double seconds) {
    std::vector<Candidate> sides = tuned;
    std::ranges::copy_if(defaults, std::back_inserter(sides), [&](const Candidate& candidate) {
      return std::ranges::find(tuned, nameOf(candidate), nameOf) == tuned.end();
    });
    const std::vector<std::optional<CaseResult>> results = duels_.measure(sides, seconds);
    std::map<std::string, std::size_t> side_of;  // by name, unless it failed
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (results[i]) side_of.emplace(nameOf(sides[i]), i);
    }
    const auto ratio = [&](std::size_t of, std::size_t to) {
      RunRatio found = *ratioWithinRun(*results[to], *results[of]);
      if (of != to && results[of]->repetitions.size() < 2) {
        found.ratio.ci95.low /= kProcessDifference;
        found.ratio.ci95.high *= kProcessDifference;
      }
      return found;
    };
    std::vector<std::size_t> chosen;
    std::map<std::size_t, std::size_t> default_of;  // of a side with better parameters
    for (std::size_t i = 0; i < tuned.size(); ++i) {
      const auto default_side = side_of.find(nameOf(defaults[i]));
      if (default_side == side_of.end()) continue;
      chosen.push_back(default_side->second);
      // Parameters are worth setting only for a clear gain.
      if (results[i] && ratio(chosen.back(), i).ratio.ci95.low > 1 + kAdviceMargin / 2) {
        chosen.back() = i;
        default_of[i] = default_side->second;
      }
    }
    std::ranges::stable_sort(chosen, {}, [&](std::size_t i) { return costOf(*results[i]); });

    Advice advice{.answer = contest.answer, .threads = contest.threads};
    for (const std::size_t i : chosen) {
      const auto has_same_algorithm = [&](const Finalist& finalist) {
        return finalist.test_case.algorithm.id == sides[i].test_case.algorithm.id;
      };
      if (std::ranges::any_of(advice.finalists, has_same_algorithm)) continue;
      advice.finalists.push_back({sides[i].test_case, ratio(i, chosen.front())});
    }
    if (!chosen.empty() && default_of.contains(chosen.front())) {
      const std::size_t i = default_of[chosen.front()];
      advice.untuned = Finalist{sides[i].test_case, ratio(i, chosen.front())};
    }
    return advice;
  }

  /// The first choice as A, the others as B.
  void addToComparison(const Advice& advice) {
    for (const Finalist& finalist : advice.finalists) {
      const std::string first = caseName(advice.finalists.front().test_case);
      comparison_.cases.push_back({.id = fmt::format("{}/{}", id_, caseName(finalist.test_case)),
                                   .baseline = fmt::format("{}/{}", id_, first),
                                   .verdict = verdictOn(finalist.ratio.ratio.ci95, kAdviceMargin),
                                   .ratio = finalist.ratio,
                                   .by_duel = true});
    }
  }

  const Options& options_;
  const std::vector<Case>& cases_;
  std::string id_;  ///< of the recording
  CandidateDuels duels_;
  double body_extent_;
  /// Whether there is a GPU, or the user named a device.
  const bool has_device_ =
      !options_.cases.device.empty() || std::ranges::any_of(computeDevices(), &ComputeDevice::gpu);
  Clock::time_point begin_ = Clock::now();
  Progress* progress_ = nullptr;
  std::set<std::string> tried_;  ///< variants of parameters
  std::string contest_name_;
  Comparison comparison_{.command = "advise", .options = {.margin = kAdviceMargin}};
};

int run(Options options) {
  OutputFiles files;
  if (std::filesystem::exists(options.source)) files.addSource(options.source);
  files.require(options.outputs);
  const InterruptGuard guard;
  options.sources = {options.source};
  if (options.cases.threads.empty()) options.cases.threads = {1, allCores()};
  addEnginesOf(options.plugins, options.hosts.hard_limit_seconds);
  Plan plan = makePlan(options, PlanUse::run);
  if (plan.entries.size() != 1) {
    throw InputError(fmt::format("advise: {} expands to {}; pass exactly one", options.source,
                                 counted(plan.entries.size(), "recording")));
  }
  PlanEntry& entry = plan.entries.front();
  if (entry.source.simulation) {
    for (const auto& [name, value] :
         applicableValues(*entry.source.simulation, options.parameters)) {
      options.opening += " --param " + shellQuoted(fmt::format("{}={}", name, value));
    }
  }
  const auto recording = openForCommand(entry.source, options.quiet);
  return Adviser(options, entry, *recording).run();
}

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  std::vector<CLI::Option*> opening;  // options that define the recording
  const auto add_opening = [&](const std::vector<CLI::Option*>& more) {
    opening.insert(opening.end(), more.begin(), more.end());
  };
  {
    const HelpGroup group(app, "What to open");
    suggestValues(app.add_option("source", options->source,
                                 fmt::format("what to run on: {}", sourceKindsText()))
                      ->type_name("SOURCE")
                      ->required(),
                  sceneIds());
    add_opening(addSceneOptions(app, options->scene));
    addParameters(app, options->parameters);
    add_opening({addPlugins(app, options->plugins), addExternal(app, options->plugins)});
  }
  CLI::Option* const answer = [&] {
    const HelpGroup group(app, "Algorithms");
    addVariants(app, options->cases)[1]->description(
        "threads of parallel variants (default: one, and all cores)");
    CLI::Option* const kind = addAnswer(app, options->cases.answer).front();
    addDevice(app, options->cases.device);
    return kind->default_str("both");
  }();
  {
    const HelpGroup group(app, "How to measure");
    addPositive(
        app, "--max-seconds", "S", options->max_seconds,
        "time for the advice as a whole, divided among its answers; many bodies may take longer");
  }
  addHosts(app, options->hosts);
  add_opening(addReadingOptions(app, options->reading));
  for (const ComparisonWriter& writer : comparisonWriters()) {
    addOutput(app, writer.name, options->outputs, writer.doc);
  }
  addQuiet(app, options->quiet);
  return [options, opening, answer] {
    options->has_answer = answer->count() > 0 || isQuery(options->cases.answer);
    options->opening = shellQuoted(options->source);
    for (const CLI::Option* option : opening) {
      for (const std::string& value : option->results()) {
        options->opening += ' ' + option->get_name();
        if (takesValue(*option)) options->opening += ' ' + shellQuoted(value);
        if (takesOptionalValue(*option)) options->opening += '=' + shellQuoted(value);
      }
    }
    return run(*options);
  };
}

}  // namespace

Command command() {
  return {.name = "advise",
          .summary = "Advises which algorithm to choose for a recording, and how to use it.",
          .examples = {"advise freefall --objects 4000",
                       "advise game.aabbs --answer events --threads 1 --max-seconds 30"},
          .add = add};
}

}  // namespace broadmark::commands::advise
