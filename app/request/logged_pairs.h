// A log of pairs as an algorithm, so that runs, lists and the inspector treat it as any other: what
// an engine answered beside the right answer, on the recording that it was logged for.
#pragma once

#include <string>

#include "broadmark/algorithm.h"

namespace broadmark {

/// The algorithm "logged". The file is read by its instances, which then throw InputError for a
/// damaged one. Throws InputError if there is no such file.
Algorithm loggedPairs(const std::string& file);

}  // namespace broadmark
