// Running algorithms on recordings in the background, as a run without the inspector does.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/harness/case_executor.h"
#include "broadmark/results/results.h"
#include "inspector/jobs/job.h"
#include "request/run_request.h"

namespace broadmark {

/// A failure of the task is what kept the plan as a whole from being run.
struct BenchmarkReport : TaskReport {
  static constexpr const char* kName = "running algorithms";
  static constexpr const char* kPrefix = "benchmark";

  /// A case that has been run.
  struct Item {
    std::string id;
    std::string name;  ///< the same with the algorithm first
    Status status = Status::ok;
    std::string reason = {};    ///< for every status but ok
    double median_seconds = 0;  ///< of a frame
    bool kept = false;          ///< it is in the results file
  };
  std::vector<Item> items;     ///< in the order in which they ended
  std::size_t cases = 0;       ///< in all
  std::filesystem::path file;  ///< the results

  [[nodiscard]] std::size_t failed() const;
  /// What it has come to, in words.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] JobStatus status() const;
};

using BackgroundBenchmark = Task<BenchmarkReport>;

/// Begins a run with these algorithms to choose from, which run where `make_host` says; its results
/// are rewritten as JSON after each recording. Throws InputError while another one is running.
void startBenchmark(BackgroundBenchmark& job, RunRequest request, std::vector<Algorithm> algorithms,
                    const ExecutorFactory& make_host);

}  // namespace broadmark
