// Selects algorithms and creates cases from them.

#include "request/cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <strings.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <thread>

#include "broadmark/cores.h"
#include "broadmark/error.h"
#include "broadmark/names.h"
#include "original/ids.h"
#include "request/former_names.h"
#include "request/plugins.h"
#include "request/sweep.h"
#include "support/words.h"

namespace broadmark {
namespace {

/// Whether `selector` matches `algorithm`, one of `known`.
bool selects(const std::string& selector, const Algorithm& algorithm,
             const std::vector<Algorithm>& known) {
  if (selector == "all") return algorithm.traits.finds_pairs;
  if (globMatches(selector, algorithm.id)) return true;
  // An id selects only its algorithm, even if a family has the same name ("sap").
  return findAlgorithm(selector, known) == nullptr &&
         ::strcasecmp(selector.c_str(), algorithm.family.c_str()) == 0;
}

/// A key of --param: [ALGORITHM:]NAME.
struct ParameterKey {
  std::string selector;  ///< of algorithms; "": all with this parameter
  std::string parameter;
};

ParameterKey parseKey(const std::string& key) {
  const auto colon = key.rfind(':');
  if (colon == std::string::npos) return {{}, key};
  return {key.substr(0, colon), key.substr(colon + 1)};
}

/// Translates an id of the original Broadmark to ours; returns other selectors unchanged.
std::string translatedSelector(const std::string& selector, const std::vector<Algorithm>& known) {
  const OriginalId* original = findOriginalId(selector);
  const Algorithm* ours = original == nullptr ? nullptr : findAlgorithm(original->algorithm, known);
  return ours == nullptr ? selector : ours->id;
}

/// Returns the parameters that apply to an algorithm, by unqualified name. Qualified keys take
/// precedence.
ParameterValues parametersOf(const Algorithm& algorithm, const ParameterValues& given,
                             const std::vector<Algorithm>& known) {
  ParameterValues values;
  std::map<std::string, std::string> qualified;  // parameter to key
  for (const auto& [key, text] : given) {
    const auto [selector, parameter] = parseKey(key);
    if (selector.empty()) {
      if (!qualified.contains(parameter)) values[parameter] = text;
    } else if (selects(translatedSelector(selector, known), algorithm, known)) {
      const auto [other, first] = qualified.emplace(parameter, key);
      if (!first) {
        throw InputError(fmt::format("--param: '{}' and '{}' both set {} of {}", other->second, key,
                                     parameter, algorithm.id));
      }
      values[parameter] = text;
    }
  }
  return applicableValues(*algorithm.create(), values);
}

/// Throws InputError unless the qualified `key` sets a parameter of one of the `cases`.
void requireUsedKey(const std::string& key, const std::vector<Case>& cases,
                    const std::vector<Algorithm>& known) {
  const auto [selector, parameter] = parseKey(key);
  const std::vector<Algorithm> named =
      selectAlgorithms({translatedSelector(selector, known)}, known, "--param");
  std::vector<std::string> parameters;
  bool is_selected = false;
  for (const Case& test_case : cases) {
    if (findAlgorithm(test_case.algorithm.id, named) == nullptr) continue;
    is_selected = true;
    std::ranges::move(parameterNames(*test_case.algorithm.create()),
                      std::back_inserter(parameters));
  }
  if (!is_selected) {
    throw InputError(
        fmt::format("--param: '{}': no selected case uses algorithm '{}'", key, selector));
  }
  requireKnownParameters({{parameter, ""}}, std::move(parameters));
}

/// Applies a part of a case's name: "avx2", "t4", "margin=0.1". Throws InputError.
void applyNamePart(Case& test_case, const std::string& part, const std::string& name) {
  const AlgorithmTraits& traits = test_case.algorithm.traits;
  const auto isa = kIsas.find(part);
  const auto answer = findAnswer(part);
  const std::size_t equals = part.find('=');
  if (isa && traits.vectorised) {
    test_case.isa = *isa;
  } else if (answer) {
    test_case.answer = *answer;
  } else if (equals != std::string::npos && equals > 0) {
    test_case.parameters[currentParameterKey(part.substr(0, equals))] = part.substr(equals + 1);
  } else if (part.size() > 1 && part[0] == 't' && part[1] >= '0' && part[1] <= '9' &&
             traits.parallel) {
    test_case.threads = parseThreadCount(part.substr(1));
  } else {
    throw InputError(fmt::format(
        "'{}': '{}' is not {}{}an answer ({}, rays:1000) or KEY=VALUE", name, part,
        traits.vectorised ? fmt::format("an instruction set ({}), ", fmt::join(kIsas.names(), ", "))
                          : "",
        traits.parallel ? "a number of threads (t4), " : "",
        fmt::join(kAnswerKinds.names(), ", ")));
  }
}

/// Whether an algorithm answers these queries, or is named.
bool answers(const Algorithm& algorithm, const CaseOptions& options) {
  const std::vector<AnswerKind>& kinds = algorithm.traits.queries;
  return std::ranges::find(kinds, options.answer.kind) != kinds.end() ||
         std::ranges::find(options.algorithms, algorithm.id) != options.algorithms.end();
}

}  // namespace

int allCores() { return availableCores(); }

int parseThreadCount(const std::string& text) {
  constexpr long long kMaxThreads = 1024;
  return static_cast<int>(parseInteger(text, "--threads", 1, kMaxThreads));
}

const Algorithm* findAlgorithm(std::string_view id, const std::vector<Algorithm>& known) {
  const auto found = std::ranges::find(known, id, &Algorithm::id);
  return found == known.end() ? nullptr : &*found;
}

const Algorithm& requireAlgorithm(const std::string& id, const std::vector<Algorithm>& known) {
  if (const Algorithm* found = findAlgorithm(id, known)) return *found;
  throw InputError(unknownName("algorithm", id, algorithmIds(known)));
}

std::vector<std::string> algorithmIds(const std::vector<Algorithm>& known) {
  std::vector<std::string> ids;
  for (const Algorithm& algorithm : known) ids.push_back(algorithm.id);
  return ids;
}

std::vector<Algorithm> selectAlgorithms(const std::vector<std::string>& selectors,
                                        const std::vector<Algorithm>& known,
                                        std::string_view option) {
  std::vector<Algorithm> algorithms;
  for (const std::string& selector : selectors) {
    bool names_any = false;
    for (const Algorithm& algorithm : known) {
      if (!selects(selector, algorithm, known)) continue;
      names_any = true;
      if (findAlgorithm(algorithm.id, algorithms) == nullptr) algorithms.push_back(algorithm);
    }
    if (!names_any) {
      throw InputError(
          fmt::format("{}: {}", option, unknownName("algorithm", selector, algorithmIds(known))));
    }
  }
  return algorithms;
}

std::vector<Case> selectCases(const CaseOptions& options, const ParameterValues& parameters,
                              const std::vector<Algorithm>& known) {
  const std::vector<int> threads =
      options.threads.empty() ? std::vector{allCores()} : options.threads;
  const std::vector<Isa> isas = options.isas.empty() ? std::vector{bestIsa()} : options.isas;
  std::vector<Case> cases;
  const auto add = [&](const Algorithm& algorithm, Isa isa, int count) {
    const ParameterValues texts = parametersOf(algorithm, parameters, known);
    for (ParameterValues& values : combinations(*algorithm.create(), texts)) {
      Case test_case =
          makeCase(algorithm, isa, count, options.device, std::move(values), options.answer);
      if (std::ranges::find(cases, caseName(test_case), caseName) == cases.end()) {
        cases.push_back(std::move(test_case));
      }
    }
  };

  std::vector<std::string> selectors;
  for (const std::string& selector : options.algorithms) {
    // The original's ids include an instruction set.
    const OriginalId* original = findOriginalId(selector);
    const Algorithm* algorithm =
        original == nullptr ? nullptr : findAlgorithm(original->algorithm, known);
    if (algorithm == nullptr) {
      selectors.push_back(selector);
      continue;
    }
    for (const int count : threads) add(*algorithm, original->isa.value_or(isas.front()), count);
  }
  if (options.algorithms.empty()) selectors.emplace_back("all");
  for (const Algorithm& algorithm : selectAlgorithms(selectors, known, "--algorithm")) {
    if (isQuery(options.answer) && !answers(algorithm, options)) continue;
    for (const int count : threads) {
      for (const Isa isa : isas) add(algorithm, isa, count);
    }
  }
  return cases;
}

/// Length of the plug-in's prefix in a case's name: "FILE.so:", "NAME:" of an SDK plug-in,
/// "external:COMMAND:" or "pairs:LOG:".
static std::size_t pluginPrefixLength(const std::string& name) {
  if (!isLibrary(name)) return name.rfind(':') + 1;
  constexpr std::string_view kLibraryEnd = ".so:";
  const auto library = name.find(kLibraryEnd);
  if (library != std::string::npos) return library + kLibraryEnd.size();
  for (const SdkPlugin& plugin : sdkPlugins()) {
    if (name.starts_with(plugin.name + ":")) return plugin.name.size() + 1;
  }
  return 0;
}

Case caseNamed(const std::string& name, const std::string& device, Answer answer,
               const VariantDefaults& defaults) {
  const std::size_t begin = pluginPrefixLength(name);
  std::vector<std::string> plugins;
  if (begin > 0) plugins.push_back(name.substr(0, begin - 1));
  const std::vector<std::string> parts = splitAt('/', name.substr(begin));
  const Algorithm algorithm = requireAlgorithm(parts.front(), availableAlgorithms(plugins));

  Case test_case = makeCase(algorithm, defaults.isa, defaults.threads, device, {}, answer);
  for (std::size_t i = 1; i < parts.size(); ++i) applyNamePart(test_case, parts[i], name);
  makeInstance(test_case);  // throws for bad parameters
  return test_case;
}

void requireUsedParameters(const ParameterValues& given, const std::vector<Case>& cases,
                           std::vector<std::string> names, const std::vector<Algorithm>& known) {
  ParameterValues unqualified;
  for (const auto& [key, text] : given) {
    if (parseKey(key).selector.empty()) {
      unqualified.emplace(key, text);
    } else {
      requireUsedKey(key, cases, known);
    }
  }
  for (const Case& test_case : cases) {
    std::ranges::move(parameterNames(*test_case.algorithm.create()), std::back_inserter(names));
  }
  requireKnownParameters(unqualified, std::move(names));
}

void requireKnownParameters(const ParameterValues& given, std::vector<std::string> known) {
  std::ranges::sort(known);
  known.erase(std::unique(known.begin(), known.end()), known.end());
  for (const auto& [name, value] : given) {
    if (std::ranges::find(known, name) == known.end()) {
      throw InputError("--param: " + unknownName("parameter", name, known));
    }
  }
}

}  // namespace broadmark
