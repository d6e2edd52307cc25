// Settings of the original as a case of ours.

#include "sources/original_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "broadmark/error.h"
#include "broadmark/names.h"
#include "original/ids.h"
#include "request/cases.h"

namespace broadmark {
namespace {

/// A setting that is a parameter of one family here.
struct OriginalParameter {
  std::string_view family;
  std::string_view name;
  std::string (*value)(const OriginalSettings&);
};

std::string gridObjectsPerCell(const OriginalSettings& settings) {
  return std::to_string(settings.grid_objects_per_cell);
}

constexpr OriginalParameter kOriginalParameters[] = {
    {"Grid BF", "objects_per_cell", gridObjectsPerCell},
    {"Grid SAP", "objects_per_cell", gridObjectsPerCell},
    {"KD", "objects_per_leaf",
     [](const OriginalSettings& s) { return std::to_string(s.kd_objects_per_leaf); }},
    {"KD", "margin",  // one for all axes here
     [](const OriginalSettings& s) { return fmt::format("{}", std::ranges::max(s.margin)); }},
    // The original never reads Tracy's own key.
    {"Tracy", "objects_per_cell", gridObjectsPerCell}};

ParameterValues originalParameters(const OriginalSettings& settings, const Algorithm& algorithm) {
  ParameterValues values;
  for (const OriginalParameter& parameter : kOriginalParameters) {
    if (parameter.family != algorithm.family) continue;
    values.emplace(parameter.name, parameter.value(settings));
  }
  return values;
}

/// The original's ids of algorithms that are known.
std::vector<std::string> knownNames(const std::vector<Algorithm>& known) {
  std::vector<std::string> names;
  for (const OriginalId& id : originalIds()) {
    if (findAlgorithm(std::string(id.algorithm), known) != nullptr) names.emplace_back(id.name);
  }
  return names;
}

}  // namespace

Case originalCase(const OriginalSettings& settings, const std::vector<Algorithm>& known) {
  const OriginalId* id = findOriginalId(settings.algorithm);
  const Algorithm* algorithm =
      id == nullptr ? nullptr : findAlgorithm(std::string(id->algorithm), known);
  if (algorithm == nullptr) {
    throw InputError("m_algorithm: " +
                     unknownName("algorithm", settings.algorithm, knownNames(known)));
  }
  const auto threads = static_cast<int>(std::clamp<std::int64_t>(settings.threads, 1, 1024));
  return makeCase(*algorithm, id->isa.value_or(bestIsa()), threads, {},
                  originalParameters(settings, *algorithm));
}

}  // namespace broadmark
