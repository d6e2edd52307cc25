// Selection of algorithms and cases.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/harness/case.h"

namespace broadmark {

/// Number of cores available to this process.
int allCores();
/// Parses a value of --threads. Throws InputError.
int parseThreadCount(const std::string& text);

/// Options that select cases.
struct CaseOptions {
  std::vector<std::string> algorithms;  ///< ids, families, globs, "all"; empty: all
  std::vector<int> threads;             ///< empty: allCores()
  std::vector<Isa> isas;                ///< empty: the widest supported
  std::string device;                   ///< compute device; "": the first
  Answer answer = {};
};

/// Returns the algorithms that match a selector (ids, families, globs, "all"), without duplicates,
/// in the order of the selectors, then of `known`. A selector that is both an id and a family
/// selects the id. Throws InputError, prefixed with `option`, for a selector without a match.
std::vector<Algorithm> selectAlgorithms(const std::vector<std::string>& selectors,
                                        const std::vector<Algorithm>& known,
                                        std::string_view option);

/// Returns a case for each selected algorithm, instruction set and thread count that it supports,
/// without duplicates; those selected by ids of the original Broadmark come first. An algorithm
/// gets the parameters it has; qualified keys ("kd:margin", "sap*:margin") take precedence; a list
/// (sweep.h) yields a case per value. Values are not validated. Throws InputError as above, and for
/// a parameter that is set twice.
std::vector<Case> selectCases(const CaseOptions& options, const ParameterValues& parameters,
                              const std::vector<Algorithm>& known);

/// What a case's name may omit.
struct VariantDefaults {
  Isa isa = bestIsa();
  int threads = allCores();
};

/// Parses a case name as written by caseName(): "kd-mt/avx2/t4/events/margin=0.1". An algorithm of
/// a plug-in is prefixed with its library's file or SDK name: "libmine.so:my-sweep",
/// "jolt:jolt-quadtree". Omitted parts default to `defaults` and to `answer`. Throws InputError.
Case caseNamed(const std::string& name, const std::string& device, Answer answer = {},
               const VariantDefaults& defaults = {});

/// Returns the algorithm with this id, or null.
const Algorithm* findAlgorithm(std::string_view id, const std::vector<Algorithm>& known);
/// Same, but throws InputError if there is none.
const Algorithm& requireAlgorithm(const std::string& id, const std::vector<Algorithm>& known);
/// All ids, for messages.
std::vector<std::string> algorithmIds(const std::vector<Algorithm>& known);

/// Throws InputError for a --param that is neither a parameter of these cases nor among `names`,
/// the parameters of scenes.
void requireUsedParameters(const ParameterValues& given, const std::vector<Case>& cases,
                           std::vector<std::string> names, const std::vector<Algorithm>& known);

/// Throws InputError for a --param that is not among the `known` names of parameters.
void requireKnownParameters(const ParameterValues& given, std::vector<std::string> known);

}  // namespace broadmark
