// broadmark compare: compares result files, case by case.

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
  std::vector<std::string> baselines;  ///< additional runs like `before`
  std::vector<fs::path> after;
  ComparisonOptions comparison;
  ResultPaths outputs;
};

NamedResults readResults(const fs::path& path) {
  return {path.string(), parseResults(readTextFile(path), path.string())};
}

/// The files to judge. A run is compared with itself only with --by.
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

/// Returns wrong_answer if a case of B is wrong, regression for any other failing case.
int statusOf(const Comparison& comparison) {
  int status = exit_status::success;
  for (const CaseComparison& compared : comparison.cases) {
    if (!comparison.fails(compared)) continue;
    const bool wrong =
        compared.status_after == Status::mismatch || compared.status_after == Status::error;
    if (wrong) return exit_status::wrong_answer;
    status = exit_status::regression;
  }
  return status;
}

int run(const Options& options) {
  const std::vector<fs::path> judged = judgedFiles(options);
  if (judged.size() > 1 && !options.outputs.empty()) {
    throw InputError("compare: output files need a single B");
  }
  std::vector<NamedResults> before = {readResults(options.before)};
  for (const std::string& path : options.baselines) before.push_back(readResults(path));
  const bool prints_output = std::ranges::any_of(
      options.outputs, [](const auto& output) { return isStandardOutput(output.second); });
  int status = exit_status::success;
  for (const fs::path& path : judged) {
    const Comparison comparison = compareResults(before, readResults(path), options.comparison);
    if (judged.size() > 1) fmt::print("B = {}\n", path.string());
    if (!prints_output) fmt::print("{}", formatComparison(comparison));
    // An empty comparison must not look like a success.
    if (!comparison.comparable()) {
      throw InputError(fmt::format("{} and {}: have no comparable cases in common",
                                   options.before.string(), path.string()));
    }
    write(options, comparison);
    const int found = statusOf(comparison);
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
      "another run like A (repeatable); with fewer than four cases, three or more runs show how "
      "much runs differ");
  addShare(app, "--margin", comparison.margin, false,
           "differences within this share are 'same'; at most --fail-above");
  addShare(app, "--fail-above", comparison.fail_above, false,
           "a case is a regression if it is slower by more than this share");
  app.add_flag("--fail-undecided", comparison.fail_undecided, "fail if any case is undecided");
  app.add_option("--by", comparison.by,
                 "compare cases that differ in this (algorithm, threads, isa or a parameter) with "
                 "the first such case of A, instead of each case with itself")
      ->type_name("NAME");
  app.add_flag("--allow-missing", comparison.allow_missing,
               "do not fail if cases of A are missing in B");
  app.add_flag("--any-conditions", comparison.any_conditions,
               "compare even across processors and build types");
  for (const ComparisonWriter& writer : comparisonWriters()) {
    addOutput(app, writer.name, options->outputs, writer.doc);
  }
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
