// broadmark compare: compares result files, case by case.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/harness/environment.h"
#include "command_line/option_types.h"
#include "commands/command.h"
#include "commands/duel_series.h"
#include "compare/comparison.h"
#include "request/hosts.h"
#include "request/plugins.h"
#include "run/recordings.h"
#include "sources/results.h"
#include "support/exit_status.h"
#include "support/interrupt.h"
#include "support/output.h"
#include "support/words.h"

namespace broadmark::commands::compare {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path before;
  std::vector<std::string> baselines;  ///< additional runs like `before`
  std::vector<fs::path> after;
  ComparisonOptions comparison;
  std::optional<double> margin;
  bool settle = false;
  fs::path program;                  ///< the build that ran A; "": this one
  std::vector<std::string> plugins;  ///< of cases to settle
  DuelOptions duel{.max_seconds = 5};
  bool quiet = false;
  OutputPaths outputs;
};

/// The files to judge. A run is compared with itself only with --by.
std::vector<fs::path> judgedFiles(const Options& options) {
  if (!options.after.empty()) return options.after;
  if (!options.comparison.by.empty()) return {options.before};
  throw InputError("compare: needs two results files, or one with --by");
}

/// Settles undecided cases by duels.
class Settling {
 public:
  Settling(const Options& options, const fs::path& after_file, Comparison& comparison)
      : options_(options),
        after_file_(after_file),
        comparison_(comparison),
        algorithms_(availableAlgorithms(options.plugins)),
        duels_("settling", comparison.count(Verdict::undecided), options.duel, comparison.options,
               options.quiet) {
    HostOptions hosts;
    make_executor_ = executorFactory(hosts);
    hosts.program = options.program;
    make_baseline_executor_ = executorFactory(hosts);
  }

  void run() {
    bool settled_any = false;
    for (CaseComparison& compared : comparison_.cases) {
      if (compared.verdict != Verdict::undecided) continue;
      if (InterruptGuard::requested()) {
        ++comparison_.not_run;
        continue;
      }
      try {
        settle(compared);
        settled_any = true;
      } catch (const Interrupted&) {
        ++comparison_.not_run;
      } catch (const InputError& error) {
        comparison_.notes.push_back(fmt::format("{}: not settled: {}", compared.id, error.what()));
      }
    }
    if (!settled_any) return;
    comparison_.notes.push_back(
        fmt::format("settled by duels, A: {}; B: this program (version {})",
                    options_.program.empty() ? "this program" : options_.program.string(),
                    thisEnvironment().version));
  }

 private:
  void settle(CaseComparison& compared) {
    PlanEntry after = entryAt(*compared.after, after_file_);
    CaseResult before = *compared.before;
    before.recording = compared.after->recording;  // the same boxes, which are at hand
    const std::string& hash = compared.after->recording.hash;
    if (!recording_ || hash != recording_hash_) {
      recording_ = openForCommand(after.source, options_.quiet);
      recording_hash_ = hash;
    }
    const CaseComparison settled = duels_.run(
        {before.id, entryAt(before, after_file_).cases.front(), make_baseline_executor_},
        {compared.id, after.cases.front(), make_executor_}, *recording_, comparison_.notes);
    compared.verdict = settled.verdict;
    compared.status_before = settled.status_before;
    compared.status_after = settled.status_after;
    compared.reason = settled.reason;
    compared.ratio = settled.ratio;
    compared.by_duel = true;
  }

  /// The case with its recording. Throws InputError if that is not at hand.
  PlanEntry entryAt(const CaseResult& result, const fs::path& file) const {
    if (const std::string obstacle = obstacleTo(result, file, algorithms_); !obstacle.empty()) {
      throw InputError(obstacle);
    }
    return entryOf(result, file, algorithms_);
  }

  const Options& options_;
  const fs::path& after_file_;
  Comparison& comparison_;
  std::vector<Algorithm> algorithms_;
  DuelSeries duels_;
  ExecutorFactory make_executor_;
  ExecutorFactory make_baseline_executor_;
  std::unique_ptr<IndexedFrames> recording_;  ///< the last one
  std::string recording_hash_;
};

int run(Options options) {
  if (options.comparison.instructions) {
    options.comparison.margin = options.margin.value_or(kCountMargin);
  } else {
    options.comparison.margin = options.margin.value_or(options.comparison.margin);
  }
  const std::vector<fs::path> judged = judgedFiles(options);
  if (judged.size() > 1 && !options.outputs.empty()) {
    throw InputError("compare: options for output files need exactly one B");
  }
  if (options.settle && options.program.empty() && options.comparison.by.empty()) {
    throw InputError(
        "compare: --settle: needs --baseline-program, the build of broadmark that ran A");
  }
  OutputFiles files;
  files.addSource(options.before);
  for (const std::string& path : options.baselines) files.addSource(path);
  for (const fs::path& path : judged) files.addSource(path);
  files.require(options.outputs);
  const InterruptGuard guard;
  std::vector<NamedResults> before = {readResults(options.before)};
  for (const std::string& path : options.baselines) before.push_back(readResults(path));
  int status = exit_status::success;
  for (const fs::path& path : judged) {
    const NamedResults after = readResults(path);
    Comparison comparison = compareResults(before, after, options.comparison);
    if (options.settle) Settling(options, path, comparison).run();
    if (judged.size() > 1) fmt::print("B = {}\n", path.string());
    if (!useStandardOutput(options.outputs)) fmt::print("{}", formatComparison(comparison));
    // An empty comparison must not look like a success.
    if (!comparison.comparable()) {
      throw InputError(fmt::format("{} and {}: no comparable cases in common",
                                   options.before.string(), path.string()));
    }
    writeComparison(options.outputs, comparison);
    if (comparison.not_run > 0) {
      throw Interrupted(fmt::format("{} not settled", counted(comparison.not_run, "case")));
    }
    const int found = comparison.exitStatus();
    if (status != exit_status::wrong_answer && found != exit_status::success) status = found;
  }
  return status;
}

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  ComparisonOptions& comparison = options->comparison;
  addPath(app, "A", "A", options->before, "results to compare with (.json, .jsonl)")->required();
  app.add_option("B", options->after, "results to judge")->type_name("B");
  addRepeatable(
      app, "--baseline", "FILE", options->baselines,
      "another run of A (repeatable); with fewer than four cases, at least three runs are needed "
      "to estimate how much runs differ");
  addValue(
      app, "--margin", "SHARE",
      [=](const std::string& text) { options->margin = parseShare(text, "--margin", false); },
      [] { return fmt::format("{:.12g}%", 100 * ComparisonOptions{}.margin); },
      fmt::format("differences within this share count as 'same'; at most --fail-above; for "
                  "instructions, {:.1g} % by default",
                  100 * kCountTolerance));
  addShare(app, "--fail-above", comparison.fail_above, false,
           "a case is a regression if it is slower by more than this share");
  CLI::Option* count = addValue(
      app, "--count", kInstructions,
      [=](const std::string& text) {
        static_cast<void>(parseCount(text));
        options->comparison.instructions = true;
      },
      [] { return std::string(); },
      "compare the instructions per frame instead of the times: of runs with --count, or "
      "where the processor counted them");
  app.add_flag("--fail-undecided", comparison.fail_undecided, "fail if any case is undecided");
  app.add_option("--by", comparison.by,
                 "compare cases that differ in NAME (algorithm, threads, isa or a parameter) with "
                 "the first of them in A, instead of each case with the same case of A")
      ->type_name("NAME");
  CLI::Option* settle =
      app.add_flag(
             "--settle", options->settle,
             "decide undecided cases by duels of --baseline-program and this program, which ran B")
          ->excludes(count);
  addPath(app, "--baseline-program", "PROGRAM", options->program,
          "for --settle: the build of broadmark that ran A")
      ->needs(settle);
  addPlugins(app, options->plugins, "algorithms, for --settle")->needs(settle);
  addExternal(app, options->plugins)->needs(settle);
  addPositive(app, "--max-seconds", "S", options->duel.max_seconds,
              "for --settle: end each duel after this many seconds")
      ->needs(settle);
  app.add_flag("--allow-missing", comparison.allow_missing,
               "do not fail if cases of A are missing in B");
  app.add_flag("--any-conditions", comparison.any_conditions,
               "compare even across processors and build types");
  for (const ComparisonWriter& writer : comparisonWriters()) {
    addOutput(app, writer.name, options->outputs, writer.doc);
  }
  addQuiet(app, options->quiet);
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {.name = "compare",
          .summary = "Compares runs (results as JSON) case by case, frame by frame.",
          .examples = {"compare before.json after.json --fail-above 10%",
                       "compare results.json --by threads"},
          .add = add};
}

}  // namespace broadmark::commands::compare
