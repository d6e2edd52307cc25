#include "inspector/jobs/background_duel.h"

#include <utility>

#include "broadmark/error.h"
#include "compare/duel_report.h"

namespace broadmark {
namespace {

/// What is known so far is copied no more often than it is looked at.
constexpr double kBetweenReports = 0.2;

}  // namespace

JobStatus DuelReport::status() const {
  return {.doing = "A duel is running.",
          .values = {{"rounds", std::to_string(result.sides.empty() ? 0 : result.rounds())},
                     {"verdict", result.ranking.empty() ? "" : verdictOf(result)}}};
}

void startDuel(BackgroundDuel& job, const std::vector<Case>& cases,
               std::unique_ptr<IndexedFrames> frames, double max_seconds,
               const ExecutorFactory& make_host) {
  if (cases.size() < 2) throw InputError("duel: one algorithm alone: add another one");
  if (frames->scene().frames == 0) throw InputError("duel: there is no frame to run");
  DuelReport first;
  first.max_seconds = max_seconds;
  std::vector<DuelSide> sides;
  for (const Case& test_case : cases) {
    sides.push_back({caseName(test_case), test_case, make_host});
    first.result.sides.push_back({.name = sides.back().name});
  }
  job.begin(std::move(first), [&job, sides = std::move(sides), frames = std::move(frames),
                               max_seconds] {
    double reported = 0;
    const auto tell = [&](const DuelResult& so_far) {
      if (so_far.seconds < reported + kBetweenReports) return;
      reported = so_far.seconds;
      job.update([&](DuelReport& report) { report.result = so_far; });
    };
    const DuelOptions options{.max_seconds = max_seconds, .progress = tell, .cancelled = [&job] {
                                return job.cancelled();
                              }};
    DuelResult result = runDuel(sides, *frames, options);
    job.update([&](DuelReport& report) { report.result = std::move(result); });
    return true;
  });
}

}  // namespace broadmark
