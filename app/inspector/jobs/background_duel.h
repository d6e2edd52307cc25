// Runs a duel in the background.
#pragma once

#include <memory>
#include <vector>

#include "broadmark/analysis/duel.h"
#include "broadmark/recordings/recording.h"
#include "inspector/jobs/job.h"

namespace broadmark {

struct DuelReport : TaskReport {
  static constexpr const char* kName = "duel";
  static constexpr const char* kPrefix = "duel";

  DuelResult result;  ///< so far; has no ranking until it is done
  double max_seconds = 0;

  [[nodiscard]] JobStatus status() const;
};

using BackgroundDuel = Task<DuelReport>;

/// Starts a duel. Throws InputError for fewer than two cases, without frames, and while another
/// duel is running.
void startDuel(BackgroundDuel& job, const std::vector<Case>& cases,
               std::unique_ptr<IndexedFrames> frames, double max_seconds,
               const ExecutorFactory& make_executor);

}  // namespace broadmark
