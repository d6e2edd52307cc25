// A comparison as annotations of GitHub's workflows: lines that a job prints.

#include <fmt/format.h>

#include "compare/comparison.h"

namespace broadmark::comparisons::github {
namespace {

/// A message as workflow commands want it.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '%' || c == '\n' || c == '\r') {
      result += fmt::format("%{:02X}", static_cast<unsigned>(c));
    } else {
      result += c;
    }
  }
  return result;
}

std::string format(const Comparison& comparison) {
  std::string text;
  for (const CaseComparison& compared : comparison.cases) {
    const bool fails = comparison.fails(compared);
    if (!fails && compared.verdict != Verdict::undecided) continue;
    text += fmt::format("::{} title=broadmark compare::{}\n", fails ? "error" : "warning",
                        escaped(fmt::format("{}: {}", compared.id, verdictText(compared))));
  }
  return text +
         fmt::format("::notice title=broadmark compare::{}\n", escaped(summaryText(comparison)));
}

}  // namespace

ComparisonWriter writer() {
  return {"github", "failures and undecided cases as annotations of GitHub's workflows", format};
}

}  // namespace broadmark::comparisons::github
