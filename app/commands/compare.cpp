// broadmark compare: result files, case by case.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "command_line/option_types.h"
#include "commands/command.h"
#include "compare/comparison.h"
#include "support/exit_status.h"
#include "support/output.h"

namespace broadmark::commands::compare {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path before;
  std::vector<std::string> baselines;  ///< more runs like `before`
  std::vector<fs::path> after;
  ComparisonOptions comparison;
  ResultPaths outputs;
};

NamedResults readResults(const fs::path& path) {
  return {path.string(), parseResults(readTextFile(path), path.string())};
}

/// Only with --by a run is compared with itself.
std::vector<fs::path> judgedFiles(const Options& options) {
  if (!options.after.empty()) return options.after;
  if (!options.comparison.by.empty()) return {options.before};
  throw InputError("compare: needs two results files, or one with --by");
}

void write(const Options& options, const Comparison& comparison) {
  for (const ComparisonWriter& writer : comparisonWriters()) {
    const auto path = options.outputs.find(std::string(writer.name));
    if (path != options.outputs.end()) writeOutput(path->second, writer.format(comparison));
  }
}

/// A wrong answer for one that has become wrong, a regression for anything else that speaks against
/// B.
int statusOf(const Comparison& comparison) {
  int status = exit_status::fine;
  for (const CaseComparison& compared : comparison.cases) {
    if (!comparison.fails(compared)) continue;
    const bool wrong =
        compared.status_before == Status::ok &&
        (compared.status_after == Status::mismatch || compared.status_after == Status::error);
    if (wrong) return exit_status::wrong_answer;
    status = exit_status::regression;
  }
  return status;
}

int run(const Options& options) {
  const std::vector<fs::path> judged = judgedFiles(options);
  if (judged.size() > 1 && !options.outputs.empty()) {
    throw InputError("compare: a file can be written for one judged run: name only one");
  }
  std::vector<NamedResults> before = {readResults(options.before)};
  for (const std::string& path : options.baselines) before.push_back(readResults(path));
  const bool prints_output = std::ranges::any_of(
      options.outputs, [](const auto& output) { return isStandardOutput(output.second); });
  int status = exit_status::fine;
  for (const fs::path& path : judged) {
    const Comparison comparison = compareResults(before, readResults(path), options.comparison);
    if (judged.size() > 1) fmt::print("B = {}\n", path.string());
    if (!prints_output) fmt::print("{}", formatComparison(comparison));
    // A comparison of nothing must not look like one that passed.
    if (!comparison.comparable()) {
      throw InputError(fmt::format("{} and {}: no case of both can be compared",
                                   options.before.string(), path.string()));
    }
    write(options, comparison);
    const int found = statusOf(comparison);
    if (status != exit_status::wrong_answer && found != exit_status::fine) status = found;
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
      "another run like A (repeatable); where there are fewer than four cases, three or more "
      "tell how much runs differ");
  addShare(app, "--margin", comparison.margin, false,
           "differences within it are 'same'; not more than --fail-above");
  addShare(app, "--fail-above", comparison.fail_above, false,
           "a case is a regression when it is slower and its ratio is beyond this");
  app.add_flag("--fail-undecided", comparison.fail_undecided, "undecided cases are failures");
  app.add_option("--by", comparison.by,
                 "compare across this instead of each case with itself: algorithm, threads, isa or "
                 "a parameter; with the first such case of A")
      ->type_name("NAME");
  app.add_flag("--allow-missing", comparison.allow_missing,
               "cases of A that are not in B are no failure");
  app.add_flag("--any-conditions", comparison.any_conditions,
               "compare other processors and build types, too");
  for (const ComparisonWriter& writer : comparisonWriters()) {
    addOutput(app, writer.name, options->outputs, writer.doc);
  }
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {.name = "compare",
          .summary = "Compares runs (results as JSON) case by case, frame by frame.",
          .add = add};
}

}  // namespace broadmark::commands::compare
