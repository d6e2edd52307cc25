// All work in the background.
#pragma once

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include "inspector/jobs/background_bake.h"
#include "inspector/jobs/background_benchmark.h"
#include "inspector/jobs/background_duel.h"
#include "inspector/jobs/background_report.h"
#include "inspector/jobs/case_export.h"

namespace broadmark {

/// One job of each kind; a new kind is a file, and a line in `jobs_`.
class Jobs {
 public:
  explicit Jobs(ExecutorFactory host_maker) : make_host(std::move(host_maker)) {}

  template <class JobType>
  [[nodiscard]] JobType& get() {
    return std::get<JobType>(jobs_);
  }
  [[nodiscard]] const std::vector<Job*>& all() const { return all_; }
  [[nodiscard]] bool running() const { return std::ranges::any_of(all_, &Job::running); }

  const ExecutorFactory make_host;  ///< where algorithms run

 private:
  std::tuple<BackgroundBake,       //
             BackgroundBenchmark,  //
             BackgroundDuel,       //
             CaseExport,           //
             BackgroundReport>
      jobs_;
  const std::vector<Job*> all_ =
      std::apply([](auto&... job) { return std::vector<Job*>{&job...}; }, jobs_);
};

}  // namespace broadmark
