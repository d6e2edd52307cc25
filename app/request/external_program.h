// Programs as algorithms (--external): frames in a shared file, calls and replies as lines of JSON
// on standard input and output. docs/external.md states the protocol.
#pragma once

#include <string>

#include "broadmark/algorithm.h"

namespace broadmark {

/// The algorithm of the program that a shell command starts, asked for its description. Each
/// instance has a process of its own. Throws InputError if it cannot be started, or gives no such
/// description.
Algorithm externalAlgorithm(const std::string& command);

}  // namespace broadmark
