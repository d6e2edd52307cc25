// A comparison as a table for people.

#include <fmt/format.h>

#include <map>

#include "compare/comparison.h"
#include "support/table.h"
#include "support/words.h"

namespace broadmark {
namespace {

std::vector<std::string> tableRow(const CaseComparison& compared) {
  std::string name = compared.id;
  if (!compared.baseline.empty()) name += fmt::format(" against {}", compared.baseline);
  if (!compared.ratio) return {name, "", "", "", "", verdictText(compared)};
  const RunRatio& ratio = *compared.ratio;
  return {name,
          durationText(ratio.before),
          durationText(ratio.after),
          fmt::format("{:.3f}", ratio.ratio.value),
          fmt::format("{:.3f}…{:.3f}", ratio.ratio.ci95.low, ratio.ratio.ci95.high),
          verdictText(compared)};
}

/// What differs beside the times, each once, with how many cases it concerns.
std::string conditionsText(const Comparison& comparison) {
  std::map<std::string, std::pair<std::size_t, bool>> found;
  for (const CaseComparison& compared : comparison.cases) {
    for (const ConditionDifference& difference : compared.conditions) {
      auto& [count, refused] = found[difference.what];
      ++count;
      refused = difference.refused;
    }
  }
  std::string text;
  for (const auto& [what, how] : found) {
    text += fmt::format("conditions differ: {} ({}){}\n", what, counted(how.first, "case"),
                        how.second && !comparison.options.any_conditions
                            ? ": not compared without --any-conditions"
                            : "");
  }
  return text;
}

}  // namespace

std::string formatComparison(const Comparison& comparison) {
  std::vector<std::vector<std::string>> rows = {
      {"case", "A", "B", "B/A", "95 % interval", "verdict"}};
  for (const CaseComparison& compared : comparison.cases) rows.push_back(tableRow(compared));
  std::string text = alignColumns(rows, {false, true, true, true, true, false});
  text += conditionsText(comparison);
  for (const std::string& note : comparison.notes) text += note + '\n';
  return text + summaryText(comparison) + '\n';
}

}  // namespace broadmark
