// A duel in the background.
#pragma once

#include <memory>
#include <vector>

#include "broadmark/analysis/duel.h"
#include "broadmark/recordings/recording.h"
#include "inspector/jobs/background_task.h"

namespace broadmark {

/// Runs one duel at a time.
class BackgroundDuel {
 public:
  struct Report : TaskReport {
    DuelResult result;  ///< so far: without places until it is done
    double seconds = 0;
    double most_seconds = 0;
    std::uint32_t bodies = 0;
  };

  /// Begins; the cases run where `make_host` says. Throws InputError for fewer than two cases, for
  /// no frame, and while another one is running.
  void start(const std::vector<Case>& cases, std::unique_ptr<IndexedFrames> frames,
             double most_seconds, const HostMaker& make_host);
  void cancel() { task_.cancel(); }
  void wait() { task_.wait(); }
  [[nodiscard]] bool running() const { return task_.running(); }
  [[nodiscard]] Report report() const { return task_.report(); }
  /// Whether one has ended since this was last asked.
  bool takeEnd() { return task_.takeEnd(); }

 private:
  BackgroundTask<Report> task_{"duel"};
};

}  // namespace broadmark
