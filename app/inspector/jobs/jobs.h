// All background jobs.
#pragma once

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include "inspector/jobs/background_bake.h"
#include "inspector/jobs/background_benchmark.h"
#include "inspector/jobs/background_duel.h"
#include "inspector/jobs/background_reading.h"
#include "inspector/jobs/background_report.h"
#include "inspector/jobs/background_save.h"
#include "inspector/jobs/case_export.h"

namespace broadmark {

/// One job of each kind. To add a kind, add a file and an element of `jobs_`.
class Jobs {
 public:
  Jobs(ExecutorFactory executor_factory, SimulationHost simulation_host)
      : make_executor(std::move(executor_factory)), host(std::move(simulation_host)) {}

  template <class JobType>
  [[nodiscard]] JobType& get() {
    return std::get<JobType>(jobs_);
  }
  [[nodiscard]] const std::vector<Job*>& all() const { return all_; }
  [[nodiscard]] bool running() const { return std::ranges::any_of(all_, &Job::running); }

  const ExecutorFactory make_executor;  ///< creates the executors that run algorithms
  const SimulationHost host;            ///< where simulations run

 private:
  std::tuple<BackgroundBake,       //
             BackgroundBenchmark,  //
             BackgroundDuel,       //
             CaseExport,           //
             BackgroundReading,    //
             BackgroundReport,     //
             BackgroundSave>
      jobs_;
  const std::vector<Job*> all_ =
      std::apply([](auto&... job) { return std::vector<Job*>{&job...}; }, jobs_);
};

}  // namespace broadmark
