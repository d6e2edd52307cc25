// Selecting algorithms and making cases of them.

#include "cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include "broadmark/error.h"
#include "broadmark/names.h"

namespace broadmark {
namespace {

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

const OriginalId* originalId(const Algorithm& algorithm, const std::string& name) {
  const auto found = std::ranges::find(algorithm.original_ids, name, &OriginalId::name);
  return found == algorithm.original_ids.end() ? nullptr : &*found;
}

/// Whether `selector` names `algorithm`, one of `known`.
bool selects(const std::string& selector, const Algorithm& algorithm,
             const std::vector<Algorithm>& known) {
  if (selector == "all") return algorithm.finds_pairs;
  if (globMatches(selector, algorithm.id)) return true;
  // An id is that algorithm alone, even where a whole family is called the same ("sap").
  const bool is_id = std::ranges::find(known, selector, &Algorithm::id) != known.end();
  return !is_id && lower(selector) == lower(algorithm.family);
}

std::vector<std::string> idsOf(const std::vector<Algorithm>& known) {
  std::vector<std::string> ids;
  for (const Algorithm& algorithm : known) ids.push_back(algorithm.id);
  return ids;
}

/// A case of `algorithm`, what it does not heed left at its neutral value.
Case makeCase(const Algorithm& algorithm, Isa isa, int threads, const ParameterValues& parameters) {
  return {.algorithm = algorithm,
          .isa = algorithm.vectorised ? isa : Isa::scalar,
          .threads = algorithm.parallel ? threads : 1,
          .parameters = applicable(*algorithm.create(), parameters)};
}

/// What the original's settings say of one family, and the parameter that it is here.
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
    {"Tracy", "objects_per_cell",  // its own key is never read there
     [](const OriginalSettings& s) { return std::to_string(s.grid_objects_per_cell); }},
};

ParameterValues originalParameters(const OriginalSettings& settings, const Algorithm& algorithm) {
  ParameterValues values;
  for (const OriginalParameter& parameter : kOriginalParameters) {
    if (parameter.family == algorithm.family) {
      values.emplace(parameter.name, parameter.value(settings));
    }
  }
  return values;
}

void addOnce(std::vector<Case>& cases, Case made) {
  const std::string name = caseName(made);
  const bool there =
      std::ranges::any_of(cases, [&](const Case& other) { return caseName(other) == name; });
  if (!there) cases.push_back(std::move(made));
}

}  // namespace

std::vector<std::string> parameterNames(Parametrised& object) {
  std::vector<std::string> names;
  object.visitParameters([&](const Parameter& p) { names.emplace_back(p.name); });
  return names;
}

ParameterValues applicable(Parametrised& object, const ParameterValues& values) {
  ParameterValues chosen;
  for (const std::string& name : parameterNames(object)) {
    if (const auto value = values.find(name); value != values.end()) chosen.insert(*value);
  }
  return chosen;
}

std::vector<Algorithm> selectAlgorithms(const std::vector<std::string>& selectors,
                                        const std::vector<Algorithm>& known) {
  for (const std::string& selector : selectors) {
    const bool names_any = std::ranges::any_of(
        known, [&](const Algorithm& algorithm) { return selects(selector, algorithm, known); });
    if (!names_any)
      throw InputError("--algorithm: " + unknownName("algorithm", selector, idsOf(known)));
  }
  std::vector<Algorithm> selected;
  for (const Algorithm& algorithm : known) {
    const auto by = [&](const std::string& selector) {
      return selects(selector, algorithm, known);
    };
    if (std::ranges::any_of(selectors, by)) selected.push_back(algorithm);
  }
  return selected;
}

std::vector<Case> selectCases(const HeadlessOptions& options, const std::vector<Algorithm>& known) {
  std::vector<Case> cases;
  std::vector<std::string> selectors;
  // The original's names state an instruction set of their own.
  for (const std::string& selector : options.algorithms) {
    const auto named = std::ranges::find_if(known, [&](const Algorithm& algorithm) {
      return originalId(algorithm, selector) != nullptr;
    });
    if (named == known.end()) {
      selectors.push_back(selector);
      continue;
    }
    for (const int threads : options.threads) {
      const Isa isa = originalId(*named, selector)->isa.value_or(options.isas.front());
      addOnce(cases, makeCase(*named, isa, threads, options.parameters));
    }
  }
  if (options.algorithms.empty()) selectors.emplace_back("all");
  for (const Algorithm& algorithm : selectAlgorithms(selectors, known)) {
    for (const int threads : options.threads) {
      for (const Isa isa : options.isas) {
        addOnce(cases, makeCase(algorithm, isa, threads, options.parameters));
      }
    }
  }
  return cases;
}

Case originalCase(const OriginalSettings& settings, const std::vector<Algorithm>& known) {
  std::vector<std::string> names;
  for (const Algorithm& algorithm : known) {
    for (const OriginalId& id : algorithm.original_ids) names.push_back(id.name);
    if (const OriginalId* id = originalId(algorithm, settings.algorithm)) {
      const auto threads = std::clamp<std::int64_t>(settings.threads, 1, 1024);
      return makeCase(algorithm, id->isa.value_or(bestIsa()), static_cast<int>(threads),
                      originalParameters(settings, algorithm));
    }
  }
  throw InputError("m_algorithm: " + unknownName("algorithm", settings.algorithm, names));
}

}  // namespace broadmark
