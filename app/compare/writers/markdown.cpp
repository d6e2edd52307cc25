// A comparison as a table in Markdown, for a pull request.

#include <fmt/format.h>

#include "compare/comparison.h"
#include "support/words.h"

namespace broadmark::comparisons::markdown {
namespace {

std::string format(const Comparison& comparison) {
  std::string text =
      "| case | A | B | B/A | 95 % interval | verdict |\n|---|--:|--:|--:|--:|---|\n";
  for (const CaseComparison& compared : comparison.cases) {
    text += fmt::format("| `{}` |", compared.id);
    if (const auto& ratio = compared.ratio) {
      text += fmt::format(" {} | {} | {:.3f} | {:.3f}…{:.3f} |", durationText(ratio->before),
                          durationText(ratio->after), ratio->ratio.value, ratio->ratio.ci95.low,
                          ratio->ratio.ci95.high);
    } else {
      text += " | | | |";
    }
    const char* bold = comparison.fails(compared) ? "**" : "";
    text += fmt::format(" {}{}{} |\n", bold, verdictText(compared), bold);
  }
  text += '\n' + summaryText(comparison) + '\n';
  for (const std::string& note : comparison.notes) text += "\n- " + note;
  return text;
}

}  // namespace

ComparisonWriter writer() { return {"markdown", "the comparison as Markdown", format}; }

}  // namespace broadmark::comparisons::markdown
