// Which algorithms and cases are meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/harness/case.h"

namespace broadmark {

/// As many threads as this process has cores.
int allCores();
/// A number of threads.
int parseThreadCount(const std::string& text);

/// Which cases to make.
struct CaseOptions {
  std::vector<std::string> algorithms;  ///< ids, families, globs, "all"; empty: all
  std::vector<int> threads;             ///< empty: as many as there are cores
  std::vector<Isa> isas;                ///< empty: the widest
  std::string device;                   ///< compute device: "" for the first
  AnswerKind answer = AnswerKind::pairs;
};

/// The algorithms that the selectors (ids, families, globs, "all") name, each once, in the order of
/// `known`. What is both an id and a family means the id. Throws InputError, which begins with
/// `option`, for a selector that names none.
std::vector<Algorithm> selectAlgorithms(const std::vector<std::string>& selectors,
                                        const std::vector<Algorithm>& known,
                                        std::string_view option);

/// All selected algorithms with all instruction sets and thread counts that they support, without
/// duplicates; first those selected by an id of the original Broadmark. An algorithm gets the
/// parameters that it has; a key that names it ("kd:margin", "sap*:margin") wins over others; every
/// value of a list (sweep.h) makes a case. The values are not checked. Throws InputError as above,
/// and for a parameter that is set twice.
std::vector<Case> selectCases(const CaseOptions& options, const ParameterValues& parameters,
                              const std::vector<Algorithm>& known);

/// The case of this name, as caseName() writes it: "kd-mt/avx2/t4/events/margin=0.1"; an algorithm
/// of a plug-in has the library's file in front, or the name of one of ours: "libmine.so:my-sweep",
/// "jolt:jolt-quadtree". What is left out is as wide as the processor, or `answer`. Throws
/// InputError.
Case caseNamed(const std::string& name, const std::string& device,
               AnswerKind answer = AnswerKind::pairs);

/// The algorithm of this id, or null.
const Algorithm* findAlgorithm(std::string_view id, const std::vector<Algorithm>& known);
/// The same; throws InputError if there is none.
const Algorithm& requireAlgorithm(const std::string& id, const std::vector<Algorithm>& known);
/// All ids, for messages.
std::vector<std::string> algorithmIds(const std::vector<Algorithm>& known);

/// Throws InputError for a --param that none of these cases has and that is not among `names`,
/// those of scenes.
void requireUsedParameters(const ParameterValues& given, const std::vector<Case>& cases,
                           std::vector<std::string> names, const std::vector<Algorithm>& known);

/// Throws InputError for a --param that is in none of the parameters' `known` names.
void requireKnownParameters(const ParameterValues& given, std::vector<std::string> known);

}  // namespace broadmark
