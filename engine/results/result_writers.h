// The formats of resultWriters(): each has a function and a file.
#pragma once

#include <string>

#include "broadmark/results/results.h"

namespace broadmark {

std::string formatJsonResults(const Results&);
std::string formatJsonLines(const Results&);
const ResultWriter::Lines& jsonLines();
std::string formatCsvResults(const Results&);
std::string formatCsvFrames(const Results&);

}  // namespace broadmark
