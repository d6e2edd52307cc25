// Parameters with several values, KEY=A,B,C: one case or recording per value.
#pragma once

#include <string>
#include <vector>

#include "broadmark/parameters.h"

namespace broadmark {

/// Splits all texts at commas, and drops empty parts.
std::vector<std::string> splitList(const std::vector<std::string>& texts);

/// Returns the comma-separated values in `text` without duplicates: numbers in ascending order,
/// other values in the given order. Values are not validated.
std::vector<std::string> valuesIn(const std::string& text);

/// Returns every combination of the values in `texts`; the last name varies fastest. Parameters of
/// type string, such as paths, and those that the object lacks have a single value, which may
/// contain commas. Values are not validated.
std::vector<ParameterValues> combinations(Parametrised& object, const ParameterValues& texts);

/// " density=0.1 seed=2": suffix for the names of a sweep's recordings; "" without parameters.
std::string sweptText(const ParameterValues& swept);

}  // namespace broadmark
