// Running algorithms on recordings in the background, as a run without the inspector does.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/harness/case_host.h"
#include "broadmark/results/results.h"
#include "inspector/jobs/background_task.h"
#include "request/run_request.h"

namespace broadmark {

/// Runs one plan at a time.
class BackgroundBenchmark {
 public:
  /// A case that has been run.
  struct Item {
    std::string id;
    std::string name;  ///< the same with the algorithm first
    Status status = Status::ok;
    std::string reason = {};    ///< for every status but ok
    double median_seconds = 0;  ///< of a frame
    bool kept = false;          ///< it is in the results file
  };
  /// A failure of the task is what kept the plan as a whole from being run.
  struct Report : WorkReport {
    std::vector<Item> items;     ///< in the order in which they ended
    std::size_t cases = 0;       ///< in all
    std::filesystem::path file;  ///< the results

    [[nodiscard]] std::size_t failed() const;
    /// What it has come to, in words.
    [[nodiscard]] std::string text() const;
  };

  /// `make_host`: where algorithms run.
  explicit BackgroundBenchmark(HostMaker make_host) : make_host_(std::move(make_host)) {}

  /// Begins a run with these algorithms to choose from; its results are written as JSON after each
  /// recording. Throws InputError while another one is running.
  void start(RunRequest request, std::vector<Algorithm> algorithms);
  /// Ends soon; finished cases are kept.
  void cancel() { task_.cancel(); }
  [[nodiscard]] bool running() const { return task_.running(); }
  [[nodiscard]] Report report() const { return task_.report(); }
  /// Whether one has ended since this was last asked.
  bool takeEnd() { return task_.takeEnd(); }

 private:
  class Observer;

  HostMaker make_host_;
  BackgroundTask<Report> task_{"running algorithms"};
};

}  // namespace broadmark
