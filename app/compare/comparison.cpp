// Matches the cases of two runs, and judges each pair by the interval of its ratio.

#include "compare/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/harness/runner.h"
#include "broadmark/names.h"
#include "support/exit_status.h"
#include "support/words.h"

namespace broadmark {
namespace {

/// A case of one run.
struct Candidate {
  const Results* results;
  const CaseResult* result;

  [[nodiscard]] const Environment& environment() const {
    return results->environments[result->environment];
  }
};

/// Identifies cases to compare: the recording's hash, the case's name without the compared part,
/// and a counter for cases that share both.
using CaseKey = std::tuple<std::string, std::string, int>;

bool isThreadCount(const std::string& part) {
  return part.size() > 1 && part[0] == 't' &&
         std::all_of(part.begin() + 1, part.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Whether a part of a case's name, other than the first, states this property.
bool states(const std::string& part, const std::string& property) {
  if (property == "threads") return isThreadCount(part);
  if (property == "isa") return kIsas.find(part).has_value();
  return part.starts_with(property + '=');
}

/// The case's name without the property `by`.
std::string nameWithout(const CaseResult& result, const std::string& by) {
  if (by == "algorithm") return {};
  std::string name = caseNameOf(result);
  if (by.empty()) return name;
  std::vector<std::string> parts = splitAt('/', name);
  std::erase_if(parts,
                [&](const std::string& part) { return &part != parts.data() && states(part, by); });
  return fmt::format("{}", fmt::join(parts, "/"));
}

/// The cases of one run with their keys, in their order.
std::vector<std::pair<CaseKey, Candidate>> keysOf(const Results& results, const std::string& by) {
  std::vector<std::pair<CaseKey, Candidate>> keys;
  std::map<std::pair<std::string, std::string>, int> seen;
  for (const CaseResult& result : results.cases) {
    const std::string name = nameWithout(result, by);
    // With --by, several cases are compared with the first; else the k-th with the k-th.
    const int index = by.empty() ? seen[{result.recording.hash, name}]++ : 0;
    keys.push_back({{result.recording.hash, name, index}, {&results, &result}});
  }
  return keys;
}

void requireKnown(const std::string& by, const Results& results) {
  std::vector<std::string> known = {"algorithm", "isa", "threads"};
  for (const CaseResult& result : results.cases) {
    for (const auto& [name, value] : result.parameters) known.push_back(name);
  }
  std::ranges::sort(known);
  known.erase(std::unique(known.begin(), known.end()), known.end());
  if (std::ranges::find(known, by) == known.end()) {
    throw InputError("--by: " + unknownName("name", by, known));
  }
}

/// What counted the instructions of a case. A timed case may have counts of the processor.
std::string_view counterOf(const CaseResult& result) {
  return kCounterSources.nameOf(result.conditions.counted_by.value_or(CounterSource::processor));
}

std::vector<ConditionDifference> differencesOf(const Candidate& before, const Candidate& after,
                                               bool instructions) {
  std::vector<ConditionDifference> differences;
  const auto compare = [&](std::string_view name, const auto& a, const auto& b, bool refused) {
    if (a != b) differences.push_back({fmt::format("{}: {} -> {}", name, a, b), refused});
  };
  const Environment& a = before.environment();
  const Environment& b = after.environment();
  // valgrind's processor is everywhere the same.
  const bool is_simulated =
      instructions && before.result->conditions.counted_by == CounterSource::valgrind;
  compare("processor", a.cpu, b.cpu, !is_simulated);
  compare("build type", a.build_type, b.build_type, true);
  compare("commit", commitName(a), commitName(b), false);
  compare("compiler", a.compiler, b.compiler, false);
  compare("compiler's options", a.compiler_flags, b.compiler_flags, false);
  compare("governor", a.governor, b.governor, false);
  const Conditions& c = before.result->conditions;
  const Conditions& d = after.result->conditions;
  compare("check", kCheckModes.nameOf(c.check), kCheckModes.nameOf(d.check), false);
  compare("in process", c.in_process, d.in_process, false);
  if (instructions) {
    compare("instructions counted by", counterOf(*before.result), counterOf(*after.result), true);
    compare("frames counted", before.result->frames.size(), after.result->frames.size(), true);
  }
  compare("plug-in's options", c.plugin.flags, d.plugin.flags, false);
  return differences;
}

Verdict verdictOn(const Estimate& ratio, const ComparisonOptions& options) {
  double margin = std::min(options.margin, options.fail_above);
  if (options.instructions) margin = std::max(margin, kCountMargin);  // never undecided
  const Verdict verdict = verdictOn(ratio.ci95, margin);
  const bool is_tolerated = verdict != Verdict::slower || ratio.value <= 1 + options.fail_above;
  return is_tolerated ? verdict : Verdict::regressed;
}

/// The verdict before times are compared: not_timed if both are ok.
Verdict verdictOnStatus(Status before, Status after) {
  if (before != after) return before == Status::ok ? Verdict::regressed : Verdict::other_status;
  return after == Status::ok ? Verdict::not_timed : Verdict::not_ok;
}

/// Compares everything except times. `before` has one case or, with several baselines, that case of
/// each. The verdict is not_timed even if the case was timed.
CaseComparison compareCase(std::span<const Candidate> before, const Candidate& after,
                           const ComparisonOptions& options) {
  const CaseResult& a = *before.front().result;
  const CaseResult& b = *after.result;
  CaseComparison compared{.id = b.id,
                          .baseline = a.id == b.id ? "" : a.id,
                          .verdict = Verdict::not_timed,
                          .conditions = differencesOf(before.front(), after, options.instructions),
                          .status_before = a.status,
                          .status_after = b.status,
                          .reason = b.reason,
                          .before = &a,
                          .after = &b};
  const auto refused = [](const ConditionDifference& difference) { return difference.refused; };
  compared.verdict = verdictOnStatus(a.status, b.status);
  if (compared.verdict == Verdict::not_timed && !options.any_conditions &&
      std::ranges::any_of(compared.conditions, refused)) {
    compared.verdict = Verdict::other_conditions;
  }
  return compared;
}

/// Sets the ratio and the verdict, unless there are no counts.
void judgeInstructions(CaseComparison& compared, const CaseResult& before, const CaseResult& after,
                       const ComparisonOptions& options) {
  compared.ratio = ratioOfInstructions(before, after);
  compared.instructions = true;
  if (compared.ratio) compared.verdict = verdictOn(compared.ratio->ratio, options);
}

/// Adds notes on a run as a whole: whether it is partial, and what may have disturbed it.
void addNotes(const NamedResults& named, const ComparisonOptions& options,
              std::vector<std::string>& notes) {
  const auto add = [&](const std::string& text) { notes.push_back(named.name + ": " + text); };
  if (!named.results.complete) add("partial: the run did not finish");
  std::set<std::string> warnings;
  if (!options.instructions &&
      !std::ranges::all_of(named.results.cases, [](const CaseResult& r) { return r.timed(); })) {
    add("has instructions instead of times: compare them with --count instructions");
  }
  for (const CaseResult& result : named.results.cases) {
    if (!result.isComplete()) {
      add(fmt::format("{}: {} of {} repetitions", result.id, result.repetitions.size(),
                      result.conditions.repetitions));
    }
    for (const std::string& warning : result.conditions.warnings) {
      if (warnings.insert(warning).second) add(warning);
    }
  }
}

/// Finds the counterpart of each case of B, and compares both.
class Matching {
 public:
  Matching(std::span<const NamedResults> before, const NamedResults& after,
           const ComparisonOptions& options)
      : options_(options), within_a_run_(before.size() == 1 && before[0].name == after.name) {
    for (const NamedResults& named : before) {
      std::set<CaseKey> keys;  // of this run
      for (const auto& [key, candidate] : keysOf(named.results, options.by)) {
        if (!keys.insert(key).second) continue;
        if (!before_.contains(key)) order_.push_back(key);
        before_[key].push_back(candidate);
        if (options.by.empty()) by_id_[candidate.result->id] = key;
      }
    }
    for (const auto& [key, candidate] : keysOf(after.results, options.by)) match(key, candidate);
    for (const CaseKey& key : order_) {
      if (matched_.contains(key)) continue;
      cases_.push_back({.id = before_.at(key).front().result->id, .verdict = Verdict::missing});
    }
    if (!options.instructions) compareTimes();
  }

  std::vector<CaseComparison> takeCases() { return std::move(cases_); }

 private:
  void match(const CaseKey& key, const Candidate& after) {
    if (const auto found = before_.find(key); found != before_.end()) {
      matched_.insert(key);
      const std::vector<Candidate>& before = found->second;
      if (!options_.by.empty() && before.front().result->id == after.result->id) return;
      cases_.push_back(compareCase(before, after, options_));
      if (cases_.back().verdict != Verdict::not_timed) return;
      if (options_.instructions) {
        judgeInstructions(cases_.back(), *before.front().result, *after.result, options_);
        return;
      }
      PairedCase& paired = timed_.emplace_back();
      timed_cases_.push_back(cases_.size() - 1);
      paired.after = after.result;
      for (const Candidate& candidate : before) {
        if (candidate.result->status == Status::ok) paired.before.push_back(candidate.result);
      }
      return;
    }
    const auto same_id = by_id_.find(after.result->id);
    const bool is_rerecorded =
        same_id != by_id_.end() && std::get<0>(same_id->second) != after.result->recording.hash;
    if (is_rerecorded) matched_.insert(same_id->second);
    cases_.push_back({.id = after.result->id,
                      .verdict = is_rerecorded ? Verdict::other_recording : Verdict::added});
  }

  void compareTimes() {
    const std::vector<std::optional<RunRatio>> ratios = ratiosOfTimed();
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      CaseComparison& compared = cases_[timed_cases_[i]];
      compared.ratio = ratios[i];
      if (ratios[i]) compared.verdict = verdictOn(ratios[i]->ratio, options_);
    }
  }

  /// With --by, each case is judged alone, as different variants need not drift alike.
  [[nodiscard]] std::vector<std::optional<RunRatio>> ratiosOfTimed() const {
    if (options_.by.empty()) return ratiosOfRuns(timed_);
    std::vector<std::optional<RunRatio>> ratios;
    for (const PairedCase& paired : timed_) {
      ratios.push_back(within_a_run_ ? ratioWithinRun(*paired.before.front(), *paired.after)
                                     : ratiosOfRuns({&paired, 1}).front());
    }
    return ratios;
  }

  const ComparisonOptions& options_;
  bool within_a_run_;
  std::map<CaseKey, std::vector<Candidate>> before_;
  std::map<std::string, CaseKey> by_id_;
  std::vector<CaseKey> order_;
  std::set<CaseKey> matched_;
  std::vector<CaseComparison> cases_;
  std::vector<PairedCase> timed_;
  std::vector<std::size_t> timed_cases_;  ///< index into cases_ of each timed case
};

/// Whether the answer in B is wrong, or its algorithm failed.
bool isWrong(const CaseComparison& compared) {
  return compared.status_after == Status::mismatch || compared.status_after == Status::error;
}

/// "+5.3 %"
std::string slowdownText(const Estimate& ratio) {
  return fmt::format("{:+.1f} %", 100 * (ratio.value - 1));
}

}  // namespace

std::size_t Comparison::count(Verdict verdict) const {
  return static_cast<std::size_t>(std::ranges::count(cases, verdict, &CaseComparison::verdict));
}

bool Comparison::fails(const CaseComparison& compared) const {
  return compared.verdict == Verdict::regressed || isWrong(compared) ||
         (compared.verdict == Verdict::missing && !options.allow_missing) ||
         (compared.verdict == Verdict::undecided && options.fail_undecided);
}

bool Comparison::comparable() const {
  return std::ranges::any_of(cases, [](const CaseComparison& compared) {
    return compared.verdict != Verdict::other_recording &&
           compared.verdict != Verdict::other_conditions && compared.verdict != Verdict::missing &&
           compared.verdict != Verdict::added;
  });
}

int Comparison::exitStatus() const {
  int status = exit_status::success;
  for (const CaseComparison& compared : cases) {
    if (isWrong(compared)) return exit_status::wrong_answer;
    if (fails(compared)) status = exit_status::regression;
  }
  return status;
}

std::optional<double> Comparison::drift() const {
  std::vector<double> drifts;
  for (const CaseComparison& compared : cases) {
    if (compared.ratio && compared.ratio->drift) drifts.push_back(*compared.ratio->drift);
  }
  if (drifts.empty()) return std::nullopt;
  return quantile(drifts, 0.5);
}

NamedResults readResults(const std::filesystem::path& path) {
  return {path.string(), parseResults(readTextFile(path), path.string())};
}

Comparison compareResults(std::span<const NamedResults> before, const NamedResults& after,
                          const ComparisonOptions& options) {
  if (!options.by.empty()) requireKnown(options.by, after.results);
  Comparison comparison{.options = options};
  for (const NamedResults& named : before) addNotes(named, options, comparison.notes);
  addNotes(after, options, comparison.notes);
  comparison.cases = Matching(before, after, comparison.options).takeCases();
  const double drift = comparison.drift().value_or(0);
  if (std::abs(drift) > options.margin) {
    comparison.notes.push_back(fmt::format(
        "the times of all cases changed by {:+.1f} % in the median: the machine changed, or "
        "something that they share; each case is judged relative to the others",
        100 * drift));
  }
  return comparison;
}

CaseComparison compareSides(const DuelResult& result, std::size_t before, std::size_t after,
                            const ComparisonOptions& options) {
  const DuelResult::Side& a = result.sides[before];
  const DuelResult::Side& b = result.sides[after];
  CaseComparison compared{.id = b.name,
                          .baseline = a.name == b.name ? "" : a.name,
                          .verdict = verdictOnStatus(a.status, b.status),
                          .status_before = a.status,
                          .status_after = b.status,
                          .reason = b.reason,
                          .by_duel = true};
  if (!result.ok() || result.rounds() == 0) return compared;
  compared.ratio = RunRatio{.before = quantile(a.seconds, 0.5),
                            .after = quantile(b.seconds, 0.5),
                            .ratio = result.ratio(after, before),
                            .drift = std::nullopt};
  compared.verdict = verdictOn(compared.ratio->ratio, options);
  return compared;
}

CaseComparison compareInstructions(const CaseResult& before, const CaseResult& after,
                                   const ComparisonOptions& options) {
  CaseComparison compared{.id = after.id,
                          .baseline = before.id == after.id ? "" : before.id,
                          .verdict = verdictOnStatus(before.status, after.status),
                          .status_before = before.status,
                          .status_after = after.status,
                          .reason = after.reason};
  if (compared.verdict == Verdict::not_timed) {
    judgeInstructions(compared, before, after, options);
  }
  return compared;
}

std::string intervalText(const Interval& interval, int digits) {
  if (!std::isfinite(interval.high)) return "too few rounds";
  return fmt::format("{:.{}f}…{:.{}f}", interval.low, digits, interval.high, digits);
}

std::string verdictText(const CaseComparison& compared) {
  std::string verdict(kVerdicts.nameOf(compared.verdict));
  const std::string reason = compared.reason.empty() ? "" : ": " + compared.reason;
  if (compared.status_before != compared.status_after) {
    return fmt::format("{} -> {} {}{}", statusName(compared.status_before),
                       statusName(compared.status_after), verdict, reason);
  }
  if (compared.verdict == Verdict::not_ok) {
    return fmt::format("{} in both{}", statusName(compared.status_after), reason);
  }
  if (compared.verdict == Verdict::faster || compared.verdict == Verdict::slower ||
      (compared.verdict == Verdict::regressed && compared.ratio)) {
    return fmt::format("{} {}", verdict, slowdownText(compared.ratio->ratio));
  }
  if (compared.verdict == Verdict::undecided) {
    const auto& [ratio, interval] = compared.ratio->ratio;
    if (!std::isfinite(interval.high)) return verdict + ": too few rounds";
    const double percent = 100 * (interval.high / ratio - 1);
    return fmt::format("{}: cannot tell within ±{:.{}f} %", verdict, percent, percent < 1 ? 1 : 0);
  }
  return verdict;
}

std::string summaryText(const Comparison& comparison) {
  std::vector<std::string> parts;
  for (const auto& [verdict, name] : kVerdicts.entries) {
    const std::size_t count = comparison.count(verdict);
    if (count > 0) parts.push_back(fmt::format("{} {}", count, name));
  }
  std::string text =
      fmt::format("{}: {}", counted(comparison.cases.size(), "case"), fmt::join(parts, ", "));
  if (const auto drift = comparison.drift()) {
    text += fmt::format("; drift {:+.1f} %", 100 * *drift);
  }
  if (comparison.not_run > 0) {
    text += fmt::format("; interrupted, {} not run", counted(comparison.not_run, "duel"));
  }
  return text;
}

}  // namespace broadmark
