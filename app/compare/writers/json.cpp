// A comparison as JSON ("schema": "broadmark-comparison/1").

#include "broadmark/json_fields.h"
#include "compare/comparison.h"

namespace broadmark::comparisons::json {
namespace {

Json caseToJson(const Comparison& comparison, const CaseComparison& compared) {
  Json json = {{"id", compared.id},
               {"baseline", compared.baseline.empty() ? compared.id : compared.baseline},
               {"verdict", kVerdicts.nameOf(compared.verdict)},
               {"fails", comparison.fails(compared)},
               {"status_before", statusName(compared.status_before)},
               {"status_after", statusName(compared.status_after)},
               {"seconds_before", nullptr},
               {"seconds_after", nullptr},
               {"ratio", nullptr},
               {"ci95", nullptr},
               {"drift", nullptr},
               {"conditions", Json::array()}};
  if (const auto& ratio = compared.ratio) {
    json["seconds_before"] = ratio->before;
    json["seconds_after"] = ratio->after;
    json["ratio"] = ratio->ratio.value;
    json["ci95"] = {ratio->ratio.ci95.low, ratio->ratio.ci95.high};
    if (ratio->drift) json["drift"] = *ratio->drift;
  }
  for (const ConditionDifference& difference : compared.conditions) {
    json["conditions"].push_back(difference.what);
  }
  return json;
}

std::string format(const Comparison& comparison) {
  Json json = {{"schema", "broadmark-comparison/1"},
               {"margin", comparison.options.margin},
               {"fail_above", comparison.options.fail_above},
               {"summary", summaryText(comparison)},
               {"notes", comparison.notes},
               {"cases", Json::array()}};
  for (const CaseComparison& compared : comparison.cases) {
    json["cases"].push_back(caseToJson(comparison, compared));
  }
  return formatJson(json);
}

}  // namespace

ComparisonWriter writer() { return {"json", "the comparison as JSON", format}; }

}  // namespace broadmark::comparisons::json
