// The list of result formats.

#include "broadmark/results/results.h"

#include "result_writers.h"

namespace broadmark {

std::vector<ResultWriter> resultWriters() {
  return {
      {"json", "results as JSON: everything, every frame's times included", formatJsonResults},
      {"jsonl",
       "the same as JSON Lines, one line per case, written during the run: an aborted run "
       "retains the finished cases",
       formatJsonLines, &jsonLines()},
      {"csv", "results as CSV: one row per case", formatCsvResults},
      {"csv-frames", "times as CSV: one row per frame", formatCsvFrames},
  };
}

}  // namespace broadmark
