// Settings files of the original Broadmark: a recording and the case to run on it.

#include "sources/original_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "broadmark/error.h"
#include "broadmark/names.h"
#include "original/ids.h"
#include "request/cases.h"
#include "sources/make_source.h"

namespace broadmark::sources::original_settings {
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

namespace {

OpenedSource open(NamedSource& source, const OpeningOptions& options) {
  const OriginalSettings settings = parseOriginalSettings(source.text(), source.name());
  OpenedSource opened;
  opened.entries.push_back(
      {.source = recordingSource(statedPath(source.path(), settings.input_scene)),
       .cases = {originalCase(settings, options.algorithms)},
       .original = settings});
  return opened;
}

}  // namespace

SourceKind kind() {
  return {.what = "settings files of the original Broadmark (.json with m_inputScene)",
          .recognises =
              [](NamedSource& source) {
                // What has a schema is ours: JSON Lines, too, which are no JSON as a whole.
                return source.isJson() && source.schema().empty() &&
                       isOriginalSettings(source.text(), source.name());
              },
          .open = open};
}

}  // namespace broadmark::sources::original_settings
