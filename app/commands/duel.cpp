// broadmark duel: determines which of several variants is fastest, and by how much; or which cases
// of a suite became slower than in another build.

#include "broadmark/analysis/duel.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>

#include "broadmark/algorithms.h"
#include "broadmark/error.h"
#include "broadmark/harness/runner.h"
#include "command_line/option_types.h"
#include "command_line/usage.h"
#include "commands/command.h"
#include "commands/duel_series.h"
#include "compare/comparison.h"
#include "compare/duel_report.h"
#include "request/cases.h"
#include "request/hosts.h"
#include "request/plugins.h"
#include "run/plan.h"
#include "run/recordings.h"
#include "run/warnings.h"
#include "sources/make_source.h"
#include "support/exit_status.h"
#include "support/interrupt.h"
#include "support/output.h"
#include "support/progress.h"
#include "support/words.h"

namespace broadmark::commands::duel {
namespace {

constexpr double kMaxSeconds = 60;
constexpr double kMaxSecondsOfCase = 10;  ///< in a suite

struct Options : RunRequest {
  std::vector<std::string> words;  ///< sources of a suite; else a source and variants
  std::vector<std::string> variants;
  std::filesystem::path program;          ///< another build of this program; "": none
  std::filesystem::path baseline_plugin;  ///< another build of a plug-in; "": none
  DuelOptions duel;
  std::optional<double> max_seconds;
  std::optional<double> fail_above;
  bool fail_undecided = false;
  bool quiet = false;

  [[nodiscard]] bool hasBaseline() const { return !program.empty() || !baseline_plugin.empty(); }
  /// Whether cases are selected as in a run, on any number of sources.
  [[nodiscard]] bool isSuite() const { return !cases.algorithms.empty() || words.size() == 1; }

  /// Without a limit, differences between variants are no regressions.
  [[nodiscard]] ComparisonOptions comparison() const {
    ComparisonOptions comparison;
    const double default_limit =
        hasBaseline() ? comparison.fail_above : std::numeric_limits<double>::infinity();
    comparison.instructions = count.instructions;
    comparison.margin = count.instructions ? kCountMargin : 2 * duel.precision;
    comparison.fail_above = fail_above.value_or(default_limit);
    comparison.fail_undecided = fail_undecided;
    return comparison;
  }
};

constexpr const char* kTooFewSides =
    "duel: needs at least two variants, or another build to compare with (--baseline-program, "
    "--baseline-plugin)";

/// Opens the source of the duel. Throws InputError unless the options name exactly one.
Source open(const Options& options) {
  Plan plan = makePlan(options, PlanUse::open, {});
  if (plan.entries.size() != 1) {
    throw InputError(fmt::format("duel: {} expands to {}; pass exactly one",
                                 options.sources.front(),
                                 counted(plan.entries.size(), "recording")));
  }
  return std::move(plan.entries.front().source);
}

std::vector<DuelSide> sidesOf(const Options& options) {
  std::vector<DuelSide> sides;
  const auto add = [&](const HostOptions& hosts, const std::string& where) {
    for (const std::string& variant : options.variants) {
      sides.push_back({variant + where,
                       options.count.instructions
                           ? countedCaseNamed(variant, options)
                           : caseNamed(variant, options.cases.device, options.cases.answer),
                       executorFactory(hosts)});
      if (options.count.instructions) requireOneThread({sides.back().test_case});
    }
  };
  add(options.hosts, "");
  if (!options.program.empty()) {
    HostOptions hosts = options.hosts;
    hosts.program = options.program;
    add(hosts, fmt::format(" ({})", options.program.string()));
  }
  if (sides.size() < 2) throw InputError(kTooFewSides);
  return sides;
}

/// The instructions of a side. Throws Interrupted.
CaseResult instructionsOf(const DuelSide& side, IndexedFrames& recording,
                          const RunRequest& options) {
  CaseResult result = beginCase(side.test_case, {.scene = recording.scene()});
  result.id = side.name;
  CaseRun case_run(side.test_case, options.policy, side.make_executor, InterruptGuard::requested);
  Oracle oracle;
  if (!runRepetition(result, case_run, recording, oracle,
                     {.cancelled = InterruptGuard::requested})) {
    throw Interrupted();
  }
  return result;
}

/// Compares the instructions of all sides with those of the first. Counts hardly vary: each side
/// runs once.
int countVariants(Options options, const std::vector<DuelSide>& sides, IndexedFrames& recording) {
  Comparison comparison{.command = "duel", .options = options.comparison()};
  std::vector<CaseResult> results;
  std::vector<Status> statuses;
  for (const DuelSide& side : sides) {
    const CaseResult& result = results.emplace_back(instructionsOf(side, recording, options));
    statuses.push_back(result.status);
    if (result.status != Status::ok) {
      comparison.notes.push_back(
          fmt::format("{}: {}: {}", result.id, statusName(result.status), result.reason));
    }
    if (results.size() == 1) continue;
    comparison.cases.push_back(compareInstructions(results.front(), result, comparison.options));
  }
  if (!useStandardOutput(options.outputs)) fmt::print("{}", formatComparison(comparison));
  writeComparison(options.outputs, comparison);
  const bool can_compare = std::ranges::count(statuses, Status::unsupported) == 0;
  const int status = exitStatusOf(statuses);
  if (status != exit_status::success) return status;
  return can_compare ? comparison.exitStatus() : exit_status::bad_input;
}

int exitStatusOf(const DuelResult& result) {
  std::vector<Status> statuses;
  for (const DuelResult::Side& side : result.sides) statuses.push_back(side.status);
  const int status = exitStatusOf(statuses);
  // A side that cannot run here leaves nothing to compare.
  return status == exit_status::success && !result.ok() ? exit_status::bad_input : status;
}

/// Opens the recording of a source. Throws InputError if it has no frame to run.
std::unique_ptr<IndexedFrames> openFrames(Source& source, const Options& options) {
  auto recording = openForCommand(source, options.quiet);
  if (recording->scene().frames > 0) return recording;
  throw InputError(fmt::format("duel: {} has no frame to run", options.sources.front()));
}

/// Prints warnings about disturbances of any side's times.
void printWarnings(const std::vector<DuelSide>& sides) {
  const Environment environment = thisEnvironment();
  RunWarnings warnings(environment);
  for (const DuelSide& side : sides) warnings.warningsFor(side.test_case);
}

/// A duel of several variants on one source, which ranks them.
int runVariants(Options options) {
  prepareCount(options);
  const std::vector<DuelSide> sides = sidesOf(options);
  Source source = open(options);
  const std::unique_ptr<IndexedFrames> recording = openFrames(source, options);
  if (options.count.instructions) return countVariants(std::move(options), sides, *recording);
  printWarnings(sides);
  constexpr double kTicks = 1000;
  Progress progress("duel", static_cast<std::uint64_t>(kTicks), options.quiet);
  options.duel.max_seconds = options.max_seconds.value_or(kMaxSeconds);
  options.duel.limit = options.fail_above.value_or(options.duel.limit);
  options.duel.progress = [&](const DuelResult& now) {
    if (!progress.isDue()) return;
    const double left = std::max(options.duel.max_seconds - now.seconds, 0.0);
    progress.detail(progressText(now));
    progress.update(
        static_cast<std::uint64_t>(kTicks * std::min(1.0, now.seconds / options.duel.max_seconds)),
        left);
  };
  const DuelResult result = runInterruptibleDuel(sides, *recording, options.duel);
  progress.update(static_cast<std::uint64_t>(kTicks));
  if (!useStandardOutput(options.outputs)) progress.print(formatDuel(result, recording->scene()));
  Comparison comparison{.command = "duel", .options = options.comparison()};
  if (!options.fail_above) {
    comparison.options.fail_above = std::numeric_limits<double>::infinity();
  }
  for (std::size_t side = 1; side < sides.size(); ++side) {
    comparison.cases.push_back(compareSides(result, 0, side, comparison.options));
  }
  if (const auto json = options.outputs.extract("json")) {
    writeOutput(json.mapped(), duelJson(result, source.reference));
  }
  writeComparison(options.outputs, comparison);
  const int status = exitStatusOf(result);
  return status == exit_status::success ? comparison.exitStatus() : status;
}

/// A suite: duels of all selected cases with their baselines, B against A.
class Suite {
 public:
  explicit Suite(const Options& options)
      : options_(options),
        plan_(planOf(options)),
        comparison_{.command = "duel", .options = options.comparison()},
        make_executor_(executorFactory(plan_.request.hosts)) {
    HostOptions hosts = plan_.request.hosts;
    hosts.program = options.program;
    make_baseline_executor_ = executorFactory(hosts);
    if (!options.program.empty()) requireWorks(make_baseline_executor_);
    if (!options.baseline_plugin.empty()) {
      baseline_algorithms_ = availableAlgorithms({options.baseline_plugin.string()});
    }
    if (options.hasBaseline()) {
      comparison_.notes.push_back(fmt::format(
          "A: {}; B: this program{}", fmt::join(baselineNames(), ", "),
          options.plugins.empty() ? "" : fmt::format(", {}", fmt::join(options.plugins, ", "))));
    }
  }

  int run() {
    std::size_t count = 0;
    for (const PlanEntry& entry : plan_.entries) {
      count += entry.cases.size() - (options_.hasBaseline() ? 0 : 1);
    }
    DuelOptions duel = options_.duel;
    duel.max_seconds = options_.max_seconds.value_or(kMaxSecondsOfCase);
    try {
      DuelSeries duels("duels", count, duel, comparison_.options, options_.quiet);
      for (PlanEntry& entry : plan_.entries) runEntry(entry, duels);
    } catch (const Interrupted&) {
      comparison_.not_run = count - comparison_.cases.size();
      if (comparison_.cases.empty()) throw;
    }
    if (!useStandardOutput(options_.outputs)) fmt::print("{}", formatComparison(comparison_));
    if (comparison_.not_run == 0 && !comparison_.comparable()) {
      throw InputError("duel: A has none of the selected cases");
    }
    writeComparison(options_.outputs, comparison_);
    if (comparison_.not_run == 0) return comparison_.exitStatus();
    throw Interrupted(
        fmt::format("{} of {} kept", comparison_.cases.size(), counted(count, "verdict")));
  }

 private:
  static Plan planOf(const Options& options) {
    Plan plan = makePlan(options, PlanUse::run);
    const bool has_same_built_ins = !options.baseline_plugin.empty() && options.program.empty();
    for (PlanEntry& entry : plan.entries) {
      std::erase_if(entry.cases, [&](const Case& test_case) {
        return has_same_built_ins && test_case.algorithm.plugin.empty();
      });
      if (!options.hasBaseline() && entry.cases.size() < 2) throw InputError(kTooFewSides);
    }
    std::erase_if(plan.entries, [](const PlanEntry& entry) { return entry.cases.empty(); });
    if (plan.entries.empty()) {
      throw InputError(has_same_built_ins ? "duel: no selected case is of a plug-in: add --plugin"
                                          : "duel: no cases left to run after --filter");
    }
    requireSupportedIsa(plan);
    return plan;
  }

  /// Throws InputError unless the program can run cases.
  static void requireWorks(const ExecutorFactory& make_executor) {
    CaseRun probe(caseNamed("none", {}), {}, make_executor);
    static_cast<void>(probe.start(SceneInfo{}, Frame{0, {}, std::span<const std::uint32_t>()}));
    if (probe.status() == Status::error) {
      throw InputError("--baseline-program: cannot run a case: " + probe.reason());
    }
  }

  [[nodiscard]] std::vector<std::string> baselineNames() const {
    std::vector<std::string> names = {options_.program.empty() ? "this program"
                                                               : options_.program.string()};
    if (!options_.baseline_plugin.empty()) names.push_back(options_.baseline_plugin.string());
    return names;
  }

  void runEntry(PlanEntry& entry, DuelSeries& duels) {
    const std::unique_ptr<IndexedFrames> recording = openFrames(entry.source, options_);
    const auto side_of = [&](const Case& test_case, const ExecutorFactory& make_executor) {
      return DuelSide{caseId(entry.source.reference, test_case), test_case, make_executor};
    };
    for (const Case& test_case : entry.cases) {
      if (!options_.hasBaseline() && &test_case == entry.cases.data()) continue;
      const DuelSide after = side_of(test_case, make_executor_);
      if (!options_.count.instructions) {
        for (const std::string& warning : warnings_.warningsFor(test_case)) addNote(warning);
      }
      const std::optional<Case> baseline =
          options_.hasBaseline() ? baselineOf(test_case) : entry.cases.front();
      if (!baseline || !runs(*baseline, make_baseline_executor_, *recording, after.name)) {
        comparison_.cases.push_back({.id = after.name, .verdict = Verdict::added});
        continue;
      }
      const DuelSide before = side_of(*baseline, make_baseline_executor_);
      comparison_.cases.push_back(duelOf(before, after, *recording, duels));
    }
  }

  CaseComparison duelOf(const DuelSide& before, const DuelSide& after, IndexedFrames& recording,
                        DuelSeries& duels) {
    if (!options_.count.instructions) {
      return duels.run(before, after, recording, comparison_.notes);
    }
    const CaseResult a = instructionsOf(before, recording, plan_.request);
    CaseComparison compared = compareInstructions(
        a, instructionsOf(after, recording, plan_.request), comparison_.options);
    duels.finish(compared);
    return compared;
  }

  /// The case in the baseline plug-in; nullopt if that has no such case.
  std::optional<Case> baselineOf(Case test_case) {
    if (test_case.algorithm.plugin.empty() || options_.baseline_plugin.empty()) return test_case;
    try {
      test_case.algorithm = requireAlgorithm(test_case.algorithm.id, baseline_algorithms_);
      static_cast<void>(makeInstance(test_case));
      return test_case;
    } catch (const InputError& error) {
      addNote(fmt::format("{}: not in A: {}", caseName(test_case), error.what()));
      return {};
    }
  }

  /// Whether the other program knows the case.
  bool runs(const Case& baseline, const ExecutorFactory& make_executor, IndexedFrames& recording,
            const std::string& id) {
    if (options_.program.empty()) return true;
    try {
      CaseRun probe(baseline, {}, make_executor);
      static_cast<void>(probe.start(recording.scene(), recording.rewind()));
      return true;
    } catch (const InputError& error) {
      addNote(fmt::format("{}: not in A: {}", id, error.what()));
      return false;
    }
  }

  void addNote(const std::string& note) {
    if (std::ranges::find(comparison_.notes, note) == comparison_.notes.end()) {
      comparison_.notes.push_back(note);
    }
  }

  const Options& options_;
  Plan plan_;
  Comparison comparison_;
  ExecutorFactory make_executor_;
  ExecutorFactory make_baseline_executor_;
  std::vector<Algorithm> baseline_algorithms_;  ///< of the other build of the plug-in
  const Environment environment_ = thisEnvironment();
  RunWarnings warnings_{environment_};
};

/// Throws InputError for a variant that looks like a source.
void requireNoSource(const std::vector<std::string>& variants) {
  const std::vector<std::string> scenes = sceneIds();
  for (const std::string& variant : variants) {
    const std::filesystem::path path = variant;
    if (std::ranges::find(scenes, variant) == scenes.end() &&
        !(path.has_extension() && std::filesystem::exists(path))) {
      continue;
    }
    throw InputError(fmt::format(
        "duel: '{}' is a source, not a variant: several sources need --algorithm", variant));
  }
}

/// Throws InputError for options that select the cases of a suite.
void requireNoSelection(const Options& options) {
  const std::pair<const char*, bool> given[] = {
      {"--threads", !options.cases.threads.empty()},
      {"--isa", !options.cases.isas.empty()},
      {"--filter", !options.filter.empty()},
      {"--baseline-plugin", !options.baseline_plugin.empty()}};
  for (const auto& [name, is_given] : given) {
    if (!is_given) continue;
    throw InputError(fmt::format(
        "{}: only with --algorithm; variants are written in full, e.g. kd-mt/avx2/t2", name));
  }
}

int run(Options options) {
  options.policy.check = options.duel.check;
  OutputFiles files;
  for (const std::string& word : options.words) {
    if (std::filesystem::exists(word)) files.addSource(word);
  }
  files.require(options.outputs);
  const InterruptGuard guard;
  if (options.isSuite()) {
    if (options.cases.algorithms.empty() && !options.hasBaseline()) throw InputError(kTooFewSides);
    options.sources = options.words;
    return Suite(options).run();
  }
  requireNoSelection(options);
  options.sources = {options.words.front()};
  options.variants.assign(options.words.begin() + 1, options.words.end());
  requireNoSource(options.variants);
  addEnginesOf(options.plugins, options.hosts.hard_limit_seconds);
  return runVariants(std::move(options));
}

std::vector<std::string> sceneAndAlgorithmIds() {
  std::vector<std::string> ids = sceneIds();
  std::ranges::move(algorithmIds(builtinAlgorithms()), std::back_inserter(ids));
  return ids;
}

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  {
    const HelpGroup group(app, "What to open");
    CLI::Option* source = app.add_option(
        "source", options->words,
        fmt::format("a source and the variants to compare on it, written like case names: "
                    "ID[/ISA][/tTHREADS][/events][/KEY=VALUE...], e.g. kd-mt/avx2/t2/margin=0.1; "
                    "from a plug-in: PLUGIN.so:ID… or NAME:ID…; without variants: with "
                    "--baseline-program or --baseline-plugin a source to compare two builds on, "
                    "with --algorithm any number of sources; a source is: {}",
                    sourceKindsText()));
    suggestValues(source->type_name("SOURCE")->required(), sceneAndAlgorithmIds());
    addSceneOptions(app, options->scene);
    addParameters(app, options->parameters);
    addPlugins(app, options->plugins);
    addExternal(app, options->plugins);
  }
  {
    const HelpGroup group(app, "Algorithms");
    addVariants(app, options->cases);
    addAnswer(app, options->cases.answer);
    addDevice(app, options->cases.device);
    addFilter(app, options->filter);
    addPath(app, "--baseline-program", "PROGRAM", options->program,
            "also run every case with this other build of broadmark, and compare");
    addPath(app, "--baseline-plugin", "FILE", options->baseline_plugin,
            "compare the algorithms of --plugin with those of this other build of it");
  }
  {
    const HelpGroup group(app, "How to measure");
    addShare(app, "--precision", options->duel.precision, true,
             "width of the ratios' intervals at which a duel ends; variants within twice this "
             "are the same");
    addValue(
        app, "--max-seconds", "S",
        [=](const std::string& text) {
          options->max_seconds = parseNumber(text, "--max-seconds", 0, true);
        },
        [] {
          return fmt::format("{}; without variants, {} for each case", kMaxSeconds,
                             kMaxSecondsOfCase);
        },
        "end a duel after this many seconds");
    addCount(app, options->count);
    addNamed(app, "--check", "MODE", options->duel.check, kCheckModes,
             "checks of the first pass: full: exact pair sets; hash: counts and hashes; off");
  }
  {
    const HelpGroup group(app, "Verdicts");
    addValue(
        app, "--fail-above", "SHARE",
        [=](const std::string& text) {
          options->fail_above = parseShare(text, "--fail-above", true);
        },
        [] {
          return fmt::format("{:.12g}% with a baseline, else none",
                             100 * ComparisonOptions{}.fail_above);
        },
        "a case is a regression if it is slower by more than this share; a duel ends when that is "
        "certain");
    app.add_flag("--fail-undecided", options->fail_undecided, "fail if any case is undecided");
  }
  addHosts(app, options->hosts);
  addReadingOptions(app, options->reading);
  for (const ComparisonWriter& writer : comparisonWriters()) {
    addOutput(app, writer.name, options->outputs, writer.doc);
  }
  addQuiet(app, options->quiet);
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {.name = "duel",
          .summary = "Compares variants, or two builds, in turns on the same frames.",
          .examples = {"duel brownian kd/t2 tide/t2 --objects 8000",
                       "duel brownian freefall --algorithm kd,tide --baseline-program ./before"},
          .add = add};
}

}  // namespace broadmark::commands::duel
