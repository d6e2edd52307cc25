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
  return {.doing = "A duel goes on.",
          .values = {{"rounds", std::to_string(result.sides.empty() ? 0 : result.rounds())},
                     {"verdict", result.places.empty() ? "" : verdictOf(result)}}};
}

void startDuel(BackgroundDuel& job, const std::vector<Case>& cases,
               std::unique_ptr<IndexedFrames> frames, double most_seconds,
               const HostMaker& make_host) {
  if (cases.size() < 2) throw InputError("duel: one algorithm alone: add another one");
  if (frames->scene().frames == 0) throw InputError("duel: there is no frame to run");
  DuelReport first;
  first.most_seconds = most_seconds;
  first.bodies = frames->scene().objects;
  std::vector<DuelSide> sides;
  for (const Case& run : cases) {
    sides.push_back({caseName(run), run, make_host});
    first.result.sides.push_back({.name = sides.back().name});
  }
  job.begin(std::move(first),
            [&job, sides = std::move(sides), frames = std::move(frames), most_seconds] {
              double reported = 0;
              DuelResult result = runDuel(sides, *frames,
                                          {.most_seconds = most_seconds,
                                           .progress =
                                               [&](const DuelResult& so_far, double seconds) {
                                                 if (seconds < reported + kBetweenReports) return;
                                                 reported = seconds;
                                                 job.update([&](DuelReport& report) {
                                                   report.result = so_far;
                                                   report.seconds = seconds;
                                                 });
                                               },
                                           .cancelled = [&job] { return job.cancelled(); }});
              job.update([&](DuelReport& report) {
                report.seconds = result.seconds;
                report.result = std::move(result);
              });
              return true;
            });
}

}  // namespace broadmark
