// Parameters with several values, as KEY=A,B,C gives them: a case or a recording for each.
#pragma once

#include <string>
#include <vector>

#include "broadmark/parameters.h"

namespace broadmark {

/// All texts split at commas, empty parts dropped.
std::vector<std::string> splitList(const std::vector<std::string>& texts);

/// The values in `text`, separated by commas, each once: numbers by size, all else in the order
/// given. A text without any comma is a single value; callers check values.
std::vector<std::string> valuesIn(const std::string& text);

/// Every combination of the values that `texts` hold; the last name varies fastest. A parameter
/// that is a text itself, such as a path, has one value, commas included; so has what the object
/// does not have. The values are not checked.
std::vector<ParameterValues> combinations(Parametrised& object, const ParameterValues& texts);

/// " density=0.1 seed=2": what tells recordings of a sweep apart, for their names; "" for none.
std::string sweptText(const ParameterValues& swept);

}  // namespace broadmark
