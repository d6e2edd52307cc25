#include "inspector/jobs/background_duel.h"

#include <utility>

#include "broadmark/error.h"
#include "compare/duel_report.h"

namespace broadmark {
namespace {

/// Minimum interval between copies of the results so far, in seconds.
constexpr double kReportInterval = 0.2;

}  // namespace

JobStatus DuelReport::status() const {
  return {.activity = "A duel is running.",
          .values = {{"rounds", std::to_string(result.sides.empty() ? 0 : result.rounds())},
                     {"verdict", result.ranking.empty() ? "" : verdictOf(result)}}};
}

void startDuel(BackgroundDuel& job, const std::vector<Case>& cases,
               std::unique_ptr<IndexedFrames> frames, double max_seconds,
               const ExecutorFactory& make_executor) {
  if (cases.size() < 2) throw InputError("duel: needs two algorithms: add another one");
  if (frames->scene().frames == 0) throw InputError("duel: no frames to run");
  DuelReport initial;
  initial.max_seconds = max_seconds;
  std::vector<DuelSide> sides;
  for (const Case& test_case : cases) {
    sides.push_back({caseName(test_case), test_case, make_executor});
    initial.result.sides.push_back({.name = sides.back().name});
  }
  job.start(std::move(initial),
            [&job, sides = std::move(sides), frames = std::move(frames), max_seconds] {
              double last_report = 0;
              const auto on_progress = [&](const DuelResult& so_far) {
                if (so_far.seconds < last_report + kReportInterval) return;
                last_report = so_far.seconds;
                job.update([&](DuelReport& report) { report.result = so_far; });
              };
              const DuelOptions options{.max_seconds = max_seconds,
                                        .progress = on_progress,
                                        .cancelled = [&job] { return job.cancelled(); }};
              DuelResult result = runDuel(sides, *frames, options);
              job.update([&](DuelReport& report) { report.result = std::move(result); });
              return true;
            });
}

}  // namespace broadmark
