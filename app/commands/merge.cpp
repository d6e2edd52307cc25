// broadmark merge: merges result files of shards and machines.

#include "broadmark/results/merge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <set>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "command_line/option_types.h"
#include "commands/command.h"
#include "run/result_files.h"
#include "support/output.h"
#include "support/words.h"

namespace broadmark::commands::merge {
namespace {

struct Options {
  std::vector<std::filesystem::path> sources;
  OutputPaths outputs;
};

int run(const Options& options) {
  if (options.outputs.empty())
    throw InputError("merge: no output given; use --json, --jsonl or --csv");
  for (const auto& [name, path] : options.outputs) requireOutput(path);
  std::vector<Results> runs;
  std::vector<std::string> names = {"merge"};
  for (const std::filesystem::path& path : options.sources) {
    runs.push_back(parseResults(readTextFile(path), path.string()));
    names.push_back(path.string());
  }
  MergedResults merged = mergeResults(runs);
  merged.results.options = names;
  // Written at once rather than line by line, as an output may be one of the sources.
  writeResults(options.outputs, merged.results);
  const auto partial = std::ranges::count_if(
      merged.results.cases, [](const CaseResult& result) { return !result.isComplete(); });
  fmt::print(stderr, "merged: {} from {}; {} found in several files; {} partial\n",
             counted(merged.results.cases.size(), "case"), counted(runs.size(), "file"),
             merged.repeated, partial);
  std::set<std::string> builds;
  for (const Environment& environment : merged.results.environments) {
    builds.insert(buildName(environment));
  }
  if (builds.size() > 1) {
    fmt::print(stderr, "results of different builds: {}\n", fmt::join(builds, "; "));
  }
  return 0;
}

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  app.add_option("results", options->sources, "results to merge (.json, .jsonl)")
      ->type_name("FILE")
      ->required();
  addResultOutputs(app, options->outputs);
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {.name = "merge",
          .summary = "Merges the results of several runs.",
          .examples = {"merge shard-0.jsonl shard-1.jsonl --json all.json",
                       "merge monday.json tuesday.json --csv all.csv"},
          .add = add};
}

}  // namespace broadmark::commands::merge
