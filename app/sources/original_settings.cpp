// Settings files of the original Broadmark: a recording and the case to run on it.

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "broadmark/error.h"
#include "broadmark/names.h"
#include "original/ids.h"
#include "request/cases.h"
#include "sources/make_source.h"

namespace broadmark::sources::original_settings {
namespace {

/// Converts settings to parameters of our algorithm.
ParameterValues originalParameters(const OriginalSettings& settings, const Algorithm& algorithm) {
  const std::string& family = algorithm.family;
  if (family == "KD") {  // a single margin for all axes
    return {{"objects_per_leaf", std::to_string(settings.kd_objects_per_leaf)},
            {"margin", fmt::format("{}", std::ranges::max(settings.margin))}};
  }
  // The original never reads Tracy's own key.
  if (family == "Grid BF" || family == "Grid SAP" || family == "Tracy") {
    return {{"objects_per_cell", std::to_string(settings.grid_objects_per_cell)}};
  }
  return {};
}

/// The original's ids of `known` algorithms.
std::vector<std::string> knownNames(const std::vector<Algorithm>& known) {
  std::vector<std::string> names;
  for (const OriginalId& id : originalIds()) {
    if (findAlgorithm(id.algorithm, known) != nullptr) names.emplace_back(id.name);
  }
  return names;
}

/// Creates the case of the settings, with one of the `known` algorithms. Throws InputError.
Case originalCase(const OriginalSettings& settings, const std::vector<Algorithm>& known) {
  const OriginalId* id = findOriginalId(settings.algorithm);
  const Algorithm* algorithm = id == nullptr ? nullptr : findAlgorithm(id->algorithm, known);
  if (algorithm == nullptr) {
    throw InputError("m_algorithm: " +
                     unknownName("algorithm", settings.algorithm, knownNames(known)));
  }
  const auto threads = static_cast<int>(std::clamp<std::int64_t>(settings.threads, 1, 1024));
  return makeCase(*algorithm, id->isa.value_or(bestIsa()), threads, {},
                  originalParameters(settings, *algorithm));
}

OpenedSource open(NamedSource& source, const OpeningOptions& options) {
  const OriginalSettings settings = parseOriginalSettings(source.text(), source.name());
  return OpenedSource({.source = recordingSource(resolvedPath(source.path(), settings.input_scene)),
                       .cases = {originalCase(settings, options.algorithms)},
                       .original = settings});
}

}  // namespace

SourceKind kind() {
  return {.what = "settings files of the original Broadmark (.json with m_inputScene)",
          .recognises =
              [](NamedSource& source) {
                // A file with a schema is ours, even JSON Lines, which are not a single JSON text.
                return source.isJson() && source.schema().empty() &&
                       isOriginalSettings(source.text(), source.name());
              },
          .open = open};
}

}  // namespace broadmark::sources::original_settings
