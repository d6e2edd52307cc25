// A duel in the background.
#pragma once

#include <memory>
#include <vector>

#include "broadmark/analysis/duel.h"
#include "broadmark/recordings/recording.h"
#include "inspector/jobs/job.h"

namespace broadmark {

struct DuelReport : TaskReport {
  DuelResult result;  ///< so far: without places until it is done
  double most_seconds = 0;
};

/// Runs one duel at a time.
class BackgroundDuel final : public ReportingJob<DuelReport> {
 public:
  BackgroundDuel() : ReportingJob("duel", "duel") {}
  ~BackgroundDuel() override { finish(); }

  /// Begins; the cases run where `make_host` says. Throws InputError for fewer than two cases, for
  /// no frame, and while another one is running.
  void start(const std::vector<Case>& cases, std::unique_ptr<IndexedFrames> frames,
             double most_seconds, const HostMaker& make_host);

 private:
  [[nodiscard]] JobStatus statusOf(const Report& report) const override;
};

}  // namespace broadmark
