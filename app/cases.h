// Which cases a run consists of.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "options.h"
#include "broadmark/algorithm.h"
#include "original/settings.h"
#include "broadmark/runner.h"

namespace broadmark {

/// The algorithms that the selectors (ids, families, globs, "all") name, each once, in the order of
/// `known`. What is both an id and a family means the id. Throws InputError for a selector that
/// names none.
std::vector<Algorithm> selectAlgorithms(const std::vector<std::string>& selectors,
                                        const std::vector<Algorithm>& known);

/// Every selected algorithm with every instruction set and thread count that it heeds.
std::vector<Case> selectCases(const HeadlessOptions&, const std::vector<Algorithm>& known);

/// The case that a settings file of the original asks for.
Case originalCase(const OriginalSettings&, const std::vector<Algorithm>& known);

/// Names of all parameters of an object.
std::vector<std::string> parameterNames(Parametrised&);
/// Those of `values` that the object has.
ParameterValues applicable(Parametrised&, const ParameterValues& values);

}  // namespace broadmark
