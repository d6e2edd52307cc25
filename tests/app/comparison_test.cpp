// Two runs, compared case by case: faster, slower, a regression, or not comparable.

#include "compare/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/helpers.h"
#include "engine/uneven_machine.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A result with this number of repetitions and frames that take about `ns`.
CaseResult resultOf(const std::string& id, std::int64_t ns, int repetitions = 3,
                    std::size_t frames = 200) {
  CaseResult result;
  result.id = id;
  result.recording.hash = "hash";
  result.parameters = {{"margin", "0"}};
  for (int r = 0; r < repetitions; ++r) {
    Repetition& repetition = result.repetitions.emplace_back();
    for (std::size_t i = 0; i < frames; ++i) {
      FrameTimes& times = repetition.frames.emplace_back();
      // A little noise, because a confidence interval requires variance.
      times[Phase::total] = ns + static_cast<std::int64_t>((i * 7 + 3U * r) % 11) * ns / 1000;
    }
  }
  return result;
}

CaseResult withStatus(CaseResult result, Status status) {
  result.status = status;
  return result;
}

NamedResults resultsOf(std::vector<CaseResult> cases) {
  return {"name.json",
          {.environments = {{}}, .options = {}, .cases = std::move(cases), .complete = true}};
}

/// Compares with three equal baselines, so that the run-to-run variance is known to be 0.
Comparison comparisonOf(const NamedResults& before, const NamedResults& after,
                        const ComparisonOptions& options = {}) {
  const std::vector<NamedResults> baselines(3, before);
  return compareResults(baselines, after, options);
}

/// The verdict on one case in both runs.
Verdict verdictOn(const CaseResult& before, const CaseResult& after, double fail_above = 0.05,
                  double margin = 0.05) {
  const Comparison comparison = comparisonOf(resultsOf({before}), resultsOf({after}),
                                             {.fail_above = fail_above, .margin = margin});
  EXPECT_EQ(comparison.cases.size(), 1U);
  const CaseComparison& compared = comparison.cases.front();
  const bool is_wrong = after.status == Status::mismatch || after.status == Status::error;
  EXPECT_EQ(comparison.fails(compared), compared.verdict == Verdict::regressed || is_wrong);
  return compared.verdict;
}

std::vector<Verdict> verdictsOf(const Comparison& comparison) {
  std::vector<Verdict> verdicts;
  for (const CaseComparison& compared : comparison.cases) verdicts.push_back(compared.verdict);
  return verdicts;
}

TEST(Compare, WithItselfIsTheSame) {
  const CaseResult result = resultOf("a", 1'000'000);
  EXPECT_EQ(verdictOn(result, result), Verdict::same);
}

TEST(Compare, TimesDecide) {
  const CaseResult normal = resultOf("a", 1'000'000);
  EXPECT_EQ(verdictOn(normal, resultOf("a", 1'500'000)), Verdict::regressed);
  EXPECT_EQ(verdictOn(normal, resultOf("a", 1'030'000), 0.05, 0.02), Verdict::slower);
  EXPECT_EQ(verdictOn(normal, resultOf("a", 700'000)), Verdict::faster);
}

TEST(Compare, OneBaselineTellsLittle) {
  const NamedResults before = resultsOf({resultOf("a", 1'000'000)});
  const auto verdict = [&](std::int64_t ns) {
    return compareResults({&before, 1}, resultsOf({resultOf("a", ns)}), {}).cases[0].verdict;
  };
  EXPECT_EQ(verdict(1'010'000), Verdict::undecided);
  EXPECT_EQ(verdict(1'050'000), Verdict::undecided);
  EXPECT_EQ(verdict(1'200'000), Verdict::regressed);
}

TEST(Compare, OneRepetitionEachTellsLittle) {
  const CaseResult once = resultOf("a", 1'000'000, 1);
  EXPECT_EQ(verdictOn(once, once), Verdict::undecided);
  EXPECT_EQ(verdictOn(once, resultOf("a", 1'100'000, 1)), Verdict::undecided);
  EXPECT_EQ(verdictOn(once, resultOf("a", 1'500'000, 1)), Verdict::regressed);
}

/// Two runs of four cases on a noisy machine, of which the last takes `factor` times as long in B.
Comparison noisyComparison(unsigned seed, double factor, const ComparisonOptions& options) {
  const auto run = [&](unsigned run_seed, double last) {
    UnevenMachine machine(run_seed);
    std::vector<CaseResult> cases;
    for (const char* id : {"a", "b", "c", "d"}) cases.push_back(resultOf(id, 0, 0));
    std::vector<double> noise(cases.size());
    for (int repetition = 0; repetition < 5; ++repetition) {
      for (std::size_t i = 0; i < cases.size(); ++i) {
        auto& frames = cases[i].repetitions.emplace_back().frames;
        for (int frame = 0; frame < 60; ++frame) {
          const double seconds = 1e-4 * (i + 1 == cases.size() ? last : 1);
          frames.emplace_back()[Phase::total] =
              static_cast<std::int64_t>(machine.time(seconds, noise[i]) * 1e9);
        }
      }
    }
    return resultsOf(std::move(cases));
  };
  const NamedResults before = run(2 * seed, 1);
  return compareResults({&before, 1}, run(2 * seed + 1, factor), options);
}

TEST(Compare, ASlowdownFarBeyondTheLimitNeverPasses) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Comparison slower = noisyComparison(seed, 1.286, {.fail_above = 0.05});
    EXPECT_EQ(slower.exitStatus(), 3) << seed;
    EXPECT_EQ(slower.cases.back().verdict, Verdict::regressed) << seed;
  }
}

TEST(Compare, TheLimitIsOnTheEstimateIfTheIntervalExcludesOne) {
  const ComparisonOptions options{.fail_above = 0.05, .margin = 0.02};
  DuelResult duel;
  duel.margin = 0.02;
  const auto verdict = [&](double ratio, double noise) {
    duel.sides = {{.name = "a"}, {.name = "b"}};
    for (int round = 0; round < 400; ++round) {
      const double sign = round * 7919 % 13 < 6 ? -1 : round * 7919 % 13 > 6 ? 1 : 0;
      duel.sides[0].seconds.push_back(1);
      duel.sides[1].seconds.push_back(ratio * (1 + sign * noise));
    }
    return compareSides(duel, 0, 1, options).verdict;
  };
  EXPECT_EQ(verdict(1.286, 0.01), Verdict::regressed);
  EXPECT_EQ(verdict(1.06, 0.001), Verdict::regressed);
  EXPECT_EQ(verdict(1.04, 0.001), Verdict::slower);
  EXPECT_EQ(verdict(1.001, 0.001), Verdict::same);
  EXPECT_EQ(verdict(0.9, 0.001), Verdict::faster);
  EXPECT_EQ(verdict(1.06, 0.5), Verdict::undecided);
}

TEST(Compare, SidesOfADuelKeepTheirStatus) {
  DuelResult duel;
  duel.sides = {{.name = "a"}, {.name = "b", .status = Status::mismatch, .reason = "1 missed"}};
  Comparison comparison{.command = "duel"};
  comparison.cases = {compareSides(duel, 0, 1, {})};
  EXPECT_EQ(comparison.cases[0].verdict, Verdict::regressed);
  EXPECT_EQ(comparison.exitStatus(), 1);
  for (const ComparisonWriter& writer : comparisonWriters()) {
    EXPECT_THAT(writer.format(comparison), HasSubstr("mismatch")) << writer.name;
  }
  std::swap(duel.sides[0].status, duel.sides[1].status);
  comparison.cases = {compareSides(duel, 0, 1, {})};
  EXPECT_EQ(comparison.exitStatus(), 0) << "it is right now";
  duel.sides[1].status = Status::mismatch;
  comparison.cases = {compareSides(duel, 0, 1, {})};
  EXPECT_EQ(comparison.exitStatus(), 1) << "as wrong as before";
}

TEST(Compare, FailAboveIsWhatIsTolerated) {
  const CaseResult before = resultOf("a", 1'000'000);
  const CaseResult after = resultOf("a", 1'500'000);
  EXPECT_EQ(verdictOn(before, after, 0.4), Verdict::regressed);
  EXPECT_EQ(verdictOn(before, after, 0.6), Verdict::slower);
  EXPECT_EQ(verdictOn(before, resultOf("a", 1'050'000), 0), Verdict::regressed);
}

TEST(Compare, ColumnsAgree) {
  const Comparison comparison =
      comparisonOf(resultsOf({resultOf("a", 1'000'000)}), resultsOf({resultOf("a", 2'000'000)}));
  const RunRatio& ratio = comparison.cases.front().ratio.value();
  EXPECT_DOUBLE_EQ(ratio.ratio.value, ratio.after / ratio.before);
  EXPECT_NEAR(ratio.ratio.value, 2, 0.01);
  EXPECT_LE(ratio.ratio.ci95.low, ratio.ratio.value);
  EXPECT_GE(ratio.ratio.ci95.high, ratio.ratio.value);
}

TEST(Compare, ALostOkIsARegression) {
  const CaseResult ok = resultOf("a", 1'000'000);
  for (const Status status :
       {Status::mismatch, Status::timeout, Status::unsupported, Status::error}) {
    EXPECT_EQ(verdictOn(ok, withStatus(ok, status)), Verdict::regressed);
    EXPECT_EQ(verdictOn(withStatus(ok, status), ok), Verdict::other_status);
    EXPECT_EQ(verdictOn(withStatus(ok, status), withStatus(ok, status)), Verdict::not_ok);
  }
  EXPECT_EQ(verdictOn(withStatus(ok, Status::timeout), withStatus(ok, Status::mismatch)),
            Verdict::other_status);
}

TEST(Compare, CasesWithoutTimesAreNotTimed) {
  CaseResult untimed = resultOf("a", 1);
  untimed.repetitions.clear();
  EXPECT_EQ(verdictOn(untimed, untimed), Verdict::not_timed);
  EXPECT_EQ(verdictOn(untimed, resultOf("a", 1'000'000)), Verdict::not_timed);
}

TEST(Compare, OtherRecordingsAreNotComparable) {
  CaseResult other = resultOf("a", 9'000'000);
  other.recording.hash = "other";
  const NamedResults before = resultsOf({resultOf("a", 1'000'000), resultOf("b", 1'000'000)});
  const Comparison partly = comparisonOf(before, resultsOf({other, resultOf("b", 1'000'000)}));
  EXPECT_THAT(verdictsOf(partly), ElementsAre(Verdict::other_recording, Verdict::same));
  EXPECT_TRUE(partly.comparable());
  EXPECT_FALSE(comparisonOf(before, resultsOf({other})).comparable());
}

// A baked recording and a live scene differ in their seeds, and therefore in their ids.
TEST(Compare, TheSameRecordingIsKnownByItsHash) {
  CaseResult live = resultOf("FreeFall/Cubes/N10/F200/s7/sap", 1'000'000);
  live.recording.scene = {"FreeFall", "Cubes", 10, 200};
  live.recording.seed = 7;
  CaseResult baked = live;
  baked.id = "FreeFall/Cubes/N10/F200/sap";
  baked.recording.seed.reset();
  const Comparison comparison = comparisonOf(resultsOf({baked}), resultsOf({live}));
  EXPECT_THAT(verdictsOf(comparison), ElementsAre(Verdict::same));
  EXPECT_EQ(comparison.cases.front().baseline, baked.id);
}

TEST(Compare, CasesOfOneRunOnly) {
  const NamedResults before = resultsOf({resultOf("gone", 1), resultOf("both", 1)});
  const NamedResults after = resultsOf({resultOf("new", 1), resultOf("both", 1)});
  const Comparison comparison = comparisonOf(before, after);
  EXPECT_THAT(verdictsOf(comparison), ElementsAre(Verdict::added, Verdict::same, Verdict::missing));
  EXPECT_EQ(comparison.cases.front().id, "new");
  EXPECT_EQ(comparison.cases.back().id, "gone");
  EXPECT_TRUE(comparison.fails(comparison.cases.back()));
  const Comparison allowed = comparisonOf(before, after, {.allow_missing = true});
  EXPECT_FALSE(allowed.fails(allowed.cases.back()));
  EXPECT_FALSE(comparisonOf(resultsOf({}), resultsOf({})).comparable());
}

TEST(Compare, CasesOfOneNameAreTakenInTurn) {
  const NamedResults twice = resultsOf({resultOf("a", 1'000'000), resultOf("a", 9'000'000)});
  EXPECT_THAT(verdictsOf(comparisonOf(twice, twice)), ElementsAre(Verdict::same, Verdict::same));
  const NamedResults thrice =
      resultsOf({resultOf("a", 1'000'000), resultOf("a", 9'000'000), resultOf("a", 1)});
  EXPECT_THAT(verdictsOf(comparisonOf(twice, thrice)),
              ElementsAre(Verdict::same, Verdict::same, Verdict::added));
}

TEST(Compare, AnotherBuildTypeIsRefusedUnlessAllowed) {
  const NamedResults before = resultsOf({resultOf("a", 1'000'000)});
  NamedResults after = before;
  after.results.environments[0].build_type = "Debug";
  const Comparison refused = comparisonOf(before, after);
  EXPECT_THAT(verdictsOf(refused), ElementsAre(Verdict::other_conditions));
  EXPECT_FALSE(refused.comparable());
  EXPECT_THAT(formatComparison(refused), HasSubstr("build type:  -> Debug"));
  EXPECT_THAT(verdictsOf(comparisonOf(before, after, {.any_conditions = true})),
              ElementsAre(Verdict::same));
}

TEST(Compare, OtherConditionsAreTold) {
  const NamedResults before = resultsOf({resultOf("a", 1'000'000)});
  NamedResults after = before;
  after.results.cases[0].conditions.check = CheckMode::off;
  const Comparison comparison = comparisonOf(before, after);
  EXPECT_THAT(verdictsOf(comparison), ElementsAre(Verdict::same));
  EXPECT_THAT(formatComparison(comparison), HasSubstr("check: full -> off"));
}

TEST(Compare, OtherCommitsAreTold) {
  const NamedResults before = resultsOf({resultOf("a", 1'000'000)});
  NamedResults after = before;
  after.results.environments[0].commit = std::string(40, 'a');
  EXPECT_THAT(formatComparison(comparisonOf(before, after)),
              HasSubstr("commit: unknown -> aaaaaaaaaa"));
}

TEST(Compare, WhatIsPartialIsTold) {
  const NamedResults before = resultsOf({resultOf("a", 1'000'000)});
  NamedResults after = before;
  after.results.complete = false;
  after.results.cases[0].conditions.repetitions = 5;
  const std::string table = formatComparison(comparisonOf(before, after));
  EXPECT_THAT(table, HasSubstr("partial"));
  EXPECT_THAT(table, HasSubstr("3 of 5 repetitions"));
}

TEST(Compare, WhatMayHaveDisturbedARunIsToldOnce) {
  NamedResults named = resultsOf({resultOf("a", 1'000'000), resultOf("b", 1'000'000)});
  for (CaseResult& result : named.results.cases) result.conditions.warnings = {"busy"};
  EXPECT_THAT(comparisonOf(resultsOf({resultOf("a", 1)}), named).notes,
              ElementsAre("name.json: busy"));
}

TEST(Compare, AcrossThreadsWithinARun) {
  const NamedResults results =
      resultsOf({resultOf("kd-mt/avx2/t1", 2'000'000), resultOf("kd-mt/avx2/t2", 1'000'000),
                 resultOf("sap-mt/t1", 1'000'000)});
  const Comparison comparison = comparisonOf(results, results, {.by = "threads"});
  ASSERT_EQ(comparison.cases.size(), 1U);
  EXPECT_EQ(comparison.cases[0].id, "kd-mt/avx2/t2");
  EXPECT_EQ(comparison.cases[0].baseline, "kd-mt/avx2/t1");
  EXPECT_NEAR(comparison.cases[0].ratio->ratio.value, 0.5, 0.01);
}

TEST(Compare, AcrossAlgorithmsAndParameters) {
  const NamedResults results = resultsOf(
      {resultOf("kd", 1'000'000), resultOf("kd/margin=1", 2'000'000), resultOf("sap", 3'000'000)});
  EXPECT_EQ(comparisonOf(results, results, {.by = "algorithm"}).cases.size(), 2U);
  const Comparison by_margin = comparisonOf(results, results, {.by = "margin"});
  ASSERT_EQ(by_margin.cases.size(), 1U);
  EXPECT_EQ(by_margin.cases[0].id, "kd/margin=1");
  EXPECT_THAT(inputErrorOf([&] { comparisonOf(results, results, {.by = "margn"}); }),
              HasSubstr("did you mean 'margin'"));
}

TEST(Compare, TheTableTellsEachVerdict) {
  const CaseResult ok = resultOf("wrong now", 1'000'000);
  const std::string table = formatComparison(comparisonOf(
      resultsOf({ok, resultOf("gone", 1), withStatus(resultOf("late", 1), Status::timeout)}),
      resultsOf({withStatus(ok, Status::mismatch), withStatus(resultOf("late", 1), Status::timeout),
                 resultOf("new", 1)})));
  for (const char* text : {"ok -> mismatch REGRESSED", "missing", "added", "timeout in both",
                           "4 cases: 1 REGRESSED, 1 not ok, 1 missing, 1 added"}) {
    EXPECT_THAT(table, HasSubstr(text));
  }
  EXPECT_THAT(table, Not(HasSubstr("faster")));
}

TEST(Compare, EveryWriterTellsOfARegression) {
  const Comparison comparison = comparisonOf(resultsOf({resultOf("a<&\"", 1'000'000)}),
                                             resultsOf({resultOf("a<&\"", 2'000'000)}));
  for (const ComparisonWriter& writer : comparisonWriters()) {
    EXPECT_THAT(writer.format(comparison), HasSubstr("REGRESSED")) << writer.name;
    if (writer.name != "junit" && writer.name != "github") continue;
    EXPECT_THAT(writer.format(comparison), HasSubstr("ratio 1.99")) << writer.name;
  }
}

}  // namespace
}  // namespace broadmark::tests
