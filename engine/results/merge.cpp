// Every run brings its environment; those that are the same but for their moment become one.

#include "broadmark/results/merge.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

namespace broadmark {
namespace {

/// Whether both are the same machine and build.
bool isSame(Environment a, const Environment& b) {
  a.started = b.started;
  a.load_average = b.load_average;
  a.governor = b.governor;
  return a == b;
}

class Merger {
 public:
  void add(const Results& run) {
    merged_.results.complete &= run.complete;
    for (const CaseResult& result : run.cases) {
      CaseResult moved = result;
      moved.environment = placeOf(run.environments[result.environment]);
      add(std::move(moved));
    }
  }

  MergedResults take() { return std::move(merged_); }

 private:
  std::size_t placeOf(const Environment& environment) {
    std::vector<Environment>& known = merged_.results.environments;
    const auto found = std::ranges::find_if(
        known, [&](const Environment& one) { return isSame(one, environment); });
    const auto place = static_cast<std::size_t>(found - known.begin());
    if (found == known.end()) known.push_back(environment);
    return place;
  }

  void add(CaseResult result) {
    std::vector<CaseResult>& cases = merged_.results.cases;
    const auto [at, is_new] =
        places_.try_emplace({result.environment, result.recording.hash, result.id}, cases.size());
    if (is_new) {
      cases.push_back(std::move(result));
      return;
    }
    ++merged_.repeated;
    CaseResult& present = cases[at->second];
    if (result.isComplete() || !present.isComplete()) present = std::move(result);
  }

  MergedResults merged_{.results = {.complete = true}};
  std::map<std::tuple<std::size_t, std::string, std::string>, std::size_t> places_;
};

}  // namespace

MergedResults mergeResults(const std::vector<Results>& runs) {
  Merger merger;
  for (const Results& run : runs) merger.add(run);
  return merger.take();
}

}  // namespace broadmark
