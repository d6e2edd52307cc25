// broadmark compare: two result files, case by case.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "commands/command.h"
#include "comparison.h"
#include "exit_status.h"
#include "option_types.h"

namespace broadmark::commands::compare {
namespace {

struct Options {
  std::filesystem::path before;
  std::filesystem::path after;
  double fail_above = 0.05;
};

Results readResults(const std::filesystem::path& path) {
  return parseResults(readTextFile(path), path.string());
}

int run(const Options& options) {
  const Comparison comparison =
      compareResults(readResults(options.before), readResults(options.after), options.fail_above);
  fmt::print("{}", formatComparison(comparison));
  // A comparison of nothing must not look like one that passed.
  if (!comparison.comparable()) {
    throw InputError(fmt::format("{} and {}: no case of both ran on the same recording",
                                 options.before.string(), options.after.string()));
  }
  return comparison.regressed() ? exit_status::regression : exit_status::fine;
}

std::function<int()> add(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  addPath(app, "before", "A.json", options->before, "results to compare with")->required();
  addPath(app, "after", "B.json", options->after, "results to judge")->required();
  const auto set = [options = options.get()](const std::string& text) {
    options->fail_above = parseNumber(text, "--fail-above", 0, false);
  };
  addValue(app, "--fail-above", "SHARE", set,
           "slow-down that counts as a regression, as a share: 0.05 is 5 %",
           fmt::format("{}", options->fail_above));
  return [options] { return run(*options); };
}

}  // namespace

Command command() {
  return {
      .name = "compare", .summary = "Compares two result files (JSON) case by case.", .add = add};
}

}  // namespace broadmark::commands::compare
