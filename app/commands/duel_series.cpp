#include "commands/duel_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compare/duel_report.h"
#include "support/interrupt.h"
#include "support/words.h"

namespace broadmark::commands {
namespace {

constexpr double kStepsPerDuel = 1000;

}  // namespace

DuelResult runInterruptibleDuel(const std::vector<DuelSide>& sides, FrameSource& recording,
                                DuelOptions options) {
  options.cancelled = InterruptGuard::requested;
  try {
    return runDuel(sides, recording, options);
  } catch (const Cancelled&) {
    throw Interrupted();
  }
}

DuelSeries::DuelSeries(std::string task, std::size_t count, const DuelOptions& options,
                       const ComparisonOptions& comparison, bool quiet)
    : options_(options),
      comparison_(comparison),
      quiet_(quiet),
      progress_(std::move(task), count * static_cast<std::uint64_t>(kStepsPerDuel), quiet) {
  options_.precision = precisionFor(std::min(comparison.margin, comparison.fail_above));
  options_.limit = comparison.fail_above;
  options_.error_rate /= static_cast<double>(std::max<std::size_t>(count, 1));
}

CaseComparison DuelSeries::run(const DuelSide& before, const DuelSide& after,
                               FrameSource& recording, std::vector<std::string>& notes) {
  options_.progress = [&](const DuelResult& now) {
    if (!progress_.isDue()) return;
    progress_.detail(fmt::format("{}: {}", after.name, progressText(now)));
    const double share = std::min(1.0, now.seconds / options_.max_seconds);
    progress_.update(
        static_cast<std::uint64_t>(kStepsPerDuel * (static_cast<double>(finished_) + share)));
  };
  const DuelResult result = runInterruptibleDuel({before, after}, recording, options_);
  CaseComparison compared = compareSides(result, 0, 1, comparison_);
  finish(compared,
         result.ok() ? fmt::format("; {} in {}", progressText(result), durationText(result.seconds))
                     : "");
  const std::uint32_t frames = recording.scene().frames;
  if (result.ok() && result.rounds() < frames) {
    notes.push_back(
        fmt::format("{}: ran frames 1 to {} of {} only: needs more time (--max-seconds)",
                    after.name, result.rounds(), frames));
  }
  return compared;
}

void DuelSeries::finish(const CaseComparison& compared, const std::string& effort) {
  ++finished_;
  if (!quiet_) {
    progress_.printError(fmt::format("{}: {}{}", compared.id, verdictText(compared), effort));
  }
  progress_.update(finished_ * static_cast<std::uint64_t>(kStepsPerDuel));
}

}  // namespace broadmark::commands
