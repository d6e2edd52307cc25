// The result formats behind resultWriters(): one function and one file each.
#pragma once

#include <string>

#include "broadmark/results.h"

namespace broadmark {

std::string formatJson(const Results&);
std::string formatCsv(const Results&);
std::string formatCsvFrames(const Results&);

}  // namespace broadmark
