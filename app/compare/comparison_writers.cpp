// Formats comparisons: as a human-readable table, and as files for other programs.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "broadmark/json_fields.h"
#include "broadmark/results/csv.h"
#include "compare/comparison.h"
#include "support/output.h"
#include "support/table.h"
#include "support/words.h"

namespace broadmark {
namespace {

/// A time, or a number of instructions.
std::string amountText(const CaseComparison& compared, double amount) {
  return compared.instructions ? fmt::format("{:.0f}", amount) : durationText(amount);
}

/// A, B, B/A and its interval.
std::vector<std::string> timeCells(const CaseComparison& compared) {
  if (!compared.ratio) return std::vector<std::string>(4);
  const RunRatio& ratio = *compared.ratio;
  return {amountText(compared, ratio.before), amountText(compared, ratio.after),
          fmt::format("{:.3f}", ratio.ratio.value), intervalText(ratio.ratio.ci95, 3)};
}

/// Verdict with the ratio and its interval, for messages without a table.
std::string messageText(const CaseComparison& compared) {
  if (!compared.ratio) return verdictText(compared);
  const auto& [ratio, interval] = compared.ratio->ratio;
  return fmt::format("{} (ratio {:.3f}, {})", verdictText(compared), ratio,
                     intervalText(interval, 3));
}

/// Differences in conditions, without duplicates, each with the number of cases affected.
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

/// Escapes a text for a cell of a table.
std::string escapedForMarkdown(std::string_view text) {
  return escaped(text, {{'|', "\\|"}, {'\n', " "}, {'\r', " "}});
}

/// The columns of a table.
std::vector<std::string> columnsOf(const Comparison& comparison) {
  if (comparison.options.instructions) {
    return {"case", "instructions of A", "instructions of B", "B/A", "tolerance", "verdict"};
  }
  return {"case", "A", "B", "B/A", "95 % interval", "verdict"};
}

std::string markdown(const Comparison& comparison) {
  std::string text =
      fmt::format("| {} |\n|---|--:|--:|--:|--:|---|\n", fmt::join(columnsOf(comparison), " | "));
  for (const CaseComparison& compared : comparison.cases) {
    text += fmt::format("| `{}`{} |", escapedForMarkdown(compared.id),
                        compared.baseline.empty()
                            ? ""
                            : fmt::format(" against `{}`", escapedForMarkdown(compared.baseline)));
    for (const std::string& cell : timeCells(compared)) {
      text += cell.empty() ? " |" : fmt::format(" {} |", cell);
    }
    const char* bold = comparison.fails(compared) ? "**" : "";
    text += fmt::format(" {}{}{} |\n", bold, escapedForMarkdown(verdictText(compared)), bold);
  }
  text += '\n' + summaryText(comparison) + '\n';
  for (const std::string& note : comparison.notes) text += "\n- " + note;
  if (!comparison.notes.empty()) text += '\n';
  return text;
}

Json caseToJson(const Comparison& comparison, const CaseComparison& compared) {
  Json json = {{"id", compared.id},
               {"baseline", compared.baseline.empty() ? compared.id : compared.baseline},
               {"verdict", kVerdicts.nameOf(compared.verdict)},
               {"fails", comparison.fails(compared)},
               {"by_duel", compared.by_duel},
               {"status_before", statusName(compared.status_before)},
               {"status_after", statusName(compared.status_after)},
               {"reason", compared.reason},
               {"seconds_before", nullptr},
               {"seconds_after", nullptr},
               {"ratio", nullptr},
               {"ci95", nullptr},
               {"drift", nullptr},
               {"conditions", Json::array()}};
  if (const auto& ratio = compared.ratio) {
    const char* unit = compared.instructions ? "instructions" : "seconds";
    json[fmt::format("{}_before", unit)] = ratio->before;
    json[fmt::format("{}_after", unit)] = ratio->after;
    json["ratio"] = ratio->ratio.value;
    const auto [low, high] = ratio->ratio.ci95;
    if (std::isfinite(high)) json["ci95"] = {low, high};
    if (ratio->drift) json["drift"] = *ratio->drift;
  }
  for (const ConditionDifference& difference : compared.conditions) {
    json["conditions"].push_back(difference.what);
  }
  return json;
}

std::string json(const Comparison& comparison) {
  Json document = {{"schema", "broadmark-comparison/1"},
                   {"margin", comparison.options.margin},
                   {"fail_above", comparison.options.fail_above},
                   {"summary", summaryText(comparison)},
                   {"notes", comparison.notes},
                   {"not_run", comparison.not_run},
                   {"cases", Json::array()}};
  for (const CaseComparison& compared : comparison.cases) {
    document["cases"].push_back(caseToJson(comparison, compared));
  }
  return formatJson(document);
}

std::string csv(const Comparison& comparison) {
  std::string text =
      "id,baseline,verdict,status_before,status_after,seconds_before,seconds_after,ratio,ci95_low,"
      "ci95_high,drift,instructions_before,instructions_after\n";
  for (const CaseComparison& compared : comparison.cases) {
    text += fmt::format("{},{},{},{},{}", csvField(compared.id), csvField(compared.baseline),
                        kVerdicts.nameOf(compared.verdict), statusName(compared.status_before),
                        statusName(compared.status_after));
    if (const auto& ratio = compared.ratio) {
      const std::string amounts = fmt::format("{:.9g},{:.9g}", ratio->before, ratio->after);
      text += fmt::format(",{},{:.6g},{:.6g},{:.6g},{},{}\n", compared.instructions ? "," : amounts,
                          ratio->ratio.value, ratio->ratio.ci95.low, ratio->ratio.ci95.high,
                          ratio->drift ? fmt::format("{:.6g}", *ratio->drift) : "",
                          compared.instructions ? amounts : ",");
    } else {
      text += ",,,,,,,,\n";
    }
  }
  return text;
}

/// Whether no judgement of the case is possible.
bool isSkipped(const CaseComparison& compared) {
  return compared.verdict == Verdict::other_conditions ||
         compared.verdict == Verdict::other_recording || compared.verdict == Verdict::not_timed;
}

std::string testCase(const Comparison& comparison, const CaseComparison& compared) {
  const std::string verdict = escapedForXml(messageText(compared));
  std::string text = fmt::format(
      "  <testcase classname=\"broadmark\" name=\"{}\" time=\"{:.9f}\"", escapedForXml(compared.id),
      compared.ratio && !compared.instructions ? compared.ratio->after : 0);
  if (comparison.fails(compared)) {
    return text + fmt::format("><failure message=\"{}\"/></testcase>\n", verdict);
  }
  if (isSkipped(compared)) {
    return text + fmt::format("><skipped message=\"{}\"/></testcase>\n", verdict);
  }
  return text + fmt::format("><system-out>{}</system-out></testcase>\n", verdict);
}

std::string junit(const Comparison& comparison) {
  const auto failures = std::ranges::count_if(
      comparison.cases, [&](const CaseComparison& compared) { return comparison.fails(compared); });
  const auto skipped = std::ranges::count_if(comparison.cases, [&](const CaseComparison& compared) {
    return isSkipped(compared) && !comparison.fails(compared);
  });
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuite name=\"broadmark {}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\">\n",
      comparison.command, comparison.cases.size(), failures, skipped);
  for (const CaseComparison& compared : comparison.cases) text += testCase(comparison, compared);
  return text + fmt::format("  <system-out>{}</system-out>\n</testsuite>\n",
                            escapedForXml(summaryText(comparison)));
}

/// Escapes a message for workflow commands.
std::string escapedForGithub(std::string_view text) {
  return escaped(text, {{'%', "%25"}, {'\n', "%0A"}, {'\r', "%0D"}});
}

std::string github(const Comparison& comparison) {
  std::string text;
  for (const CaseComparison& compared : comparison.cases) {
    const bool fails = comparison.fails(compared);
    if (!fails && compared.verdict != Verdict::undecided) continue;
    text += fmt::format(
        "::{} title=broadmark {}::{}\n", fails ? "error" : "warning", comparison.command,
        escapedForGithub(fmt::format("{}: {}", compared.id, messageText(compared))));
  }
  return text + fmt::format("::notice title=broadmark {}::{}\n", comparison.command,
                            escapedForGithub(summaryText(comparison)));
}

}  // namespace

std::vector<std::vector<std::string>> comparisonTable(const Comparison& comparison) {
  std::vector<std::vector<std::string>> rows = {columnsOf(comparison)};
  for (const CaseComparison& compared : comparison.cases) {
    std::vector<std::string>& row = rows.emplace_back(timeCells(compared));
    const std::string& baseline = compared.baseline;
    row.insert(row.begin(), compared.id + (baseline.empty() ? "" : " against " + baseline));
    row.push_back(verdictText(compared));
  }
  return rows;
}

std::string formatComparison(const Comparison& comparison) {
  std::string text =
      alignColumns(comparisonTable(comparison), {false, true, true, true, true, false});
  text += conditionsText(comparison);
  for (const std::string& note : comparison.notes) text += note + '\n';
  return text + summaryText(comparison) + '\n';
}

std::vector<ComparisonWriter> comparisonWriters() {
  return {{"markdown", "the comparison as Markdown", markdown},
          {"json", "the comparison as JSON", json},
          {"csv", "the comparison as CSV", csv},
          {"junit", "the comparison as JUnit XML", junit},
          {"github", "failures and undecided cases as annotations of GitHub's workflows", github}};
}

void writeComparison(const OutputPaths& paths, const Comparison& comparison) {
  for (const ComparisonWriter& writer : comparisonWriters()) {
    const auto path = paths.find(std::string(writer.name));
    if (path != paths.end()) writeOutput(path->second, writer.format(comparison));
  }
}

}  // namespace broadmark
