// Environments that differ only in time and load are merged.

#include "broadmark/results/merge.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

namespace broadmark {
namespace {

/// Whether both have the same machine and build.
bool isSame(Environment a, const Environment& b) {
  a.started = b.started;
  a.load_average = b.load_average;
  a.governor = b.governor;
  return a == b;
}

}  // namespace

MergedResults mergeResults(const std::vector<Results>& runs) {
  MergedResults merged{.results = {.complete = true}};
  std::vector<Environment>& environments = merged.results.environments;
  std::vector<CaseResult>& cases = merged.results.cases;
  std::map<std::tuple<std::size_t, std::string, std::string>, std::size_t> index_of;
  for (const Results& source : runs) {
    merged.results.complete &= source.complete;
    for (CaseResult result : source.cases) {
      const Environment& environment = source.environments[result.environment];
      const auto match = std::ranges::find_if(
          environments, [&](const Environment& other) { return isSame(other, environment); });
      result.environment = static_cast<std::size_t>(match - environments.begin());
      if (match == environments.end()) environments.push_back(environment);
      const auto [entry, is_new] = index_of.try_emplace(
          {result.environment, result.recording.hash, result.id}, cases.size());
      if (is_new) {
        cases.push_back(std::move(result));
        continue;
      }
      ++merged.repeated;
      CaseResult& previous = cases[entry->second];
      if (result.isComplete() || !previous.isComplete()) previous = std::move(result);
    }
  }
  return merged;
}

}  // namespace broadmark
