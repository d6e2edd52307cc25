#include "request/repetitions.h"

#include <algorithm>
#include <numeric>

namespace broadmark {

bool RepetitionRule::isEnough(const CaseResult& result) const {
  const int done = static_cast<int>(result.repetitions.size());
  if (done >= options_.max_count) return true;
  if (!options_.until_precise || done < RepetitionOptions::kMinUntilPrecise) return false;
  const std::chrono::duration<double> passed = Clock::now() - start_;
  if (passed.count() >= options_.max_seconds) return true;
  return isPrecise(result);
}

bool RepetitionRule::isPrecise(const CaseResult& result) const {
  if (!options_.until_precise) return true;
  const Summary summary = result.summary();
  return summary.ci95 &&
         summary.ci95->high - summary.ci95->low <= options_.precision * summary.seconds_per_frame;
}

int RepetitionRule::expected(const CaseResult& result) const {
  return options_.until_precise ? static_cast<int>(result.repetitions.size()) : options_.max_count;
}

TurnOrder::TurnOrder(std::size_t cases, std::uint64_t seed) : order_(cases), random_(seed) {
  std::iota(order_.begin(), order_.end(), 0);
}

void TurnOrder::shuffle() { std::ranges::shuffle(order_, random_); }

}  // namespace broadmark
