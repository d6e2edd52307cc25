// A comparison as JUnit XML, which CI systems show case by case.

#include <fmt/format.h>

#include <algorithm>

#include "compare/comparison.h"

namespace broadmark::comparisons::junit {
namespace {

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:  // XML has no way to write other control characters
        result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return result;
}

/// Whether nothing can be said of the case.
bool isSkipped(const CaseComparison& compared) {
  return compared.verdict == Verdict::other_conditions ||
         compared.verdict == Verdict::other_recording || compared.verdict == Verdict::not_timed;
}

std::string testCase(const Comparison& comparison, const CaseComparison& compared) {
  const std::string verdict = escaped(verdictText(compared));
  std::string text = fmt::format("  <testcase classname=\"broadmark\" name=\"{}\" time=\"{:.9f}\"",
                                 escaped(compared.id), compared.ratio ? compared.ratio->after : 0);
  if (comparison.fails(compared)) {
    return text + fmt::format("><failure message=\"{}\"/></testcase>\n", verdict);
  }
  if (isSkipped(compared)) {
    return text + fmt::format("><skipped message=\"{}\"/></testcase>\n", verdict);
  }
  return text + fmt::format("><system-out>{}</system-out></testcase>\n", verdict);
}

std::string format(const Comparison& comparison) {
  const auto failures = std::ranges::count_if(
      comparison.cases, [&](const CaseComparison& one) { return comparison.fails(one); });
  const auto skipped = std::ranges::count_if(comparison.cases, [&](const CaseComparison& one) {
    return isSkipped(one) && !comparison.fails(one);
  });
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuite name=\"broadmark compare\" tests=\"{}\" failures=\"{}\" skipped=\"{}\">\n",
      comparison.cases.size(), failures, skipped);
  for (const CaseComparison& compared : comparison.cases) text += testCase(comparison, compared);
  return text + fmt::format("  <system-out>{}</system-out>\n</testsuite>\n",
                            escaped(summaryText(comparison)));
}

}  // namespace

ComparisonWriter writer() { return {"junit", "the comparison as JUnit XML", format}; }

}  // namespace broadmark::comparisons::junit
