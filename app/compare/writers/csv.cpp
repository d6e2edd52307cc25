// A comparison as CSV: one row per case.

#include <fmt/format.h>

#include "broadmark/results/csv.h"
#include "compare/comparison.h"

namespace broadmark::comparisons::csv {
namespace {

std::string format(const Comparison& comparison) {
  std::string text =
      "id,baseline,verdict,status_before,status_after,seconds_before,seconds_after,ratio,ci95_low,"
      "ci95_high,drift\n";
  for (const CaseComparison& compared : comparison.cases) {
    text += fmt::format("{},{},{},{},{}", csvField(compared.id), csvField(compared.baseline),
                        kVerdicts.nameOf(compared.verdict), statusName(compared.status_before),
                        statusName(compared.status_after));
    if (const auto& ratio = compared.ratio) {
      text += fmt::format(",{:.9g},{:.9g},{:.6g},{:.6g},{:.6g},{}\n", ratio->before, ratio->after,
                          ratio->ratio.value, ratio->ratio.ci95.low, ratio->ratio.ci95.high,
                          ratio->drift ? fmt::format("{:.6g}", *ratio->drift) : "");
    } else {
      text += ",,,,,,\n";
    }
  }
  return text;
}

}  // namespace

ComparisonWriter writer() { return {"csv", "the comparison as CSV", format}; }

}  // namespace broadmark::comparisons::csv
