#include "request/repetitions.h"

#include <algorithm>
#include <numeric>

namespace broadmark {

bool RepetitionRule::isPrecise(const CaseResult& result) const {
  const Summary summary = result.summary();
  if (!summary.ci95) return false;
  return summary.ci95->high - summary.ci95->low <= options_.precision * summary.seconds_per_frame;
}

bool RepetitionRule::isTimeUp() const {
  return std::chrono::duration<double>(Clock::now() - begin_).count() >= options_.most_seconds;
}

bool RepetitionRule::isEnough(const CaseResult& result) const {
  const int done = static_cast<int>(result.repetitions.size());
  if (done >= options_.most) return true;
  if (!options_.until_precise || done < RepetitionOptions::kFewestUntilPrecise) return false;
  return isTimeUp() || isPrecise(result);
}

int RepetitionRule::wanted(const CaseResult& result) const {
  return options_.until_precise ? static_cast<int>(result.repetitions.size()) : options_.most;
}

TurnOrder::TurnOrder(std::size_t cases, std::uint64_t seed) : order_(cases), random_(seed) {
  std::iota(order_.begin(), order_.end(), 0);
}

void TurnOrder::shuffle() { std::ranges::shuffle(order_, random_); }

}  // namespace broadmark
