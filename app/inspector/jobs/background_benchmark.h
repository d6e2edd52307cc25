// Runs algorithms on recordings in the background, like a run without the inspector.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/harness/case_executor.h"
#include "broadmark/results/results.h"
#include "inspector/jobs/job.h"
#include "request/run_request.h"
#include "request/simulation_process.h"

namespace broadmark {

/// `failure` is an error of the whole plan; those of single cases are in the items.
struct BenchmarkReport : TaskReport {
  static constexpr const char* kName = "running algorithms";
  static constexpr const char* kPrefix = "benchmark";

  /// A finished case.
  struct Item {
    std::string id;
    std::string name;  ///< the id with the algorithm first
    Status status = Status::ok;
    std::string reason = {};    ///< set unless the status is ok
    double median_seconds = 0;  ///< per frame
    bool saved = false;         ///< written to the results file
  };
  std::vector<Item> items;     ///< in order of completion
  std::size_t cases = 0;       ///< total number of cases
  std::filesystem::path file;  ///< the results file

  [[nodiscard]] std::size_t failed() const;
  /// Summary of the results: "5 of 8 cases run".
  [[nodiscard]] std::string text() const;
  [[nodiscard]] JobStatus status() const;
};

using BackgroundBenchmark = Task<BenchmarkReport>;

/// Starts a run with the available algorithms; rewrites its results as JSON after each recording.
/// Throws InputError while another run is active.
void startBenchmark(BackgroundBenchmark& job, RunRequest request, std::vector<Algorithm> algorithms,
                    const ExecutorFactory& make_executor,
                    const SimulationHost& host = simulateInProcess);

}  // namespace broadmark
