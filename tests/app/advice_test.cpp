// Advice: halving, excerpts, values of parameters, and what is said.

#include "compare/advice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "request/cases.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Halve, FindsTheFastestAsMeasurementsGetMorePrecise) {
  // Each is 10 % slower than the next; errors of 5 % on all of them, then of less.
  std::vector<std::size_t> measured;
  const std::vector<std::size_t> left =
      halve(12, 3, [&](const std::vector<std::size_t>& candidates) {
        measured.push_back(candidates.size());
        const double error = 0.6 / static_cast<double>(12 * measured.size());
        std::vector<double> costs;
        for (const std::size_t i : candidates) {
          costs.push_back(std::pow(1.1, 12.0 - static_cast<double>(i)) *
                          (i % 2 == 0 ? 1 - error : 1 + error));
        }
        return costs;
      });
  EXPECT_THAT(measured, ElementsAre(12U, 6U));
  EXPECT_THAT(left, ElementsAre(11U, 10U, 9U));
}

TEST(Halve, DropsWhatMustNotBeChosen) {
  const auto costs_of = [](std::vector<double> costs) {
    return [costs = std::move(costs)](const std::vector<std::size_t>& candidates) {
      std::vector<double> chosen;
      for (const std::size_t i : candidates) chosen.push_back(costs[i]);
      return chosen;
    };
  };
  EXPECT_THAT(halve(5, 3, costs_of({kInfinity, 3, 1, kInfinity, 2})), ElementsAre(2U, 4U, 1U));
  EXPECT_THAT(halve(2, 3, costs_of({kInfinity, 1})), ElementsAre(1U));
  EXPECT_THAT(halve(2, 3, costs_of({kInfinity, kInfinity})), IsEmpty());
}

TEST(Excerpt, OfAShortRecordingIsTheWhole) {
  const Excerpt excerpt = excerptOf(3, 3);
  EXPECT_THAT(excerpt.frames, ElementsAre(0U, 1U, 2U, 3U));
  EXPECT_THAT(excerpt.counts, ElementsAre(true, true, true));
}

TEST(Excerpt, IsSpreadOverALongRecording) {
  const Excerpt excerpt = excerptOf(1000, 64);
  EXPECT_EQ(excerpt.stretches, 8U);
  EXPECT_THAT(excerpt.counts, SizeIs(64));
  EXPECT_LT(excerpt.frames.front(), 1000 / 8);
  EXPECT_GT(excerpt.frames.back(), 1000 - 1000 / 8);
}

TEST(Excerpt, CountsNoFrameAfterAGap) {
  for (const std::uint32_t frames : {1U, 2U, 30U, 100U, 1000U}) {
    for (std::uint32_t wanted = 1; wanted <= frames; ++wanted) {
      const Excerpt excerpt = excerptOf(frames, wanted);
      ASSERT_EQ(excerpt.frames.size(), excerpt.counts.size() + 1);
      ASSERT_LE(excerpt.frames.back(), frames);
      ASSERT_LE(excerpt.counts.size(), wanted);
      ASSERT_TRUE(excerpt.counts.back());
      for (std::size_t i = 0; i < excerpt.counts.size(); ++i) {
        ASSERT_GT(excerpt.frames[i + 1], excerpt.frames[i]);
        const bool is_next = excerpt.frames[i + 1] == excerpt.frames[i] + 1;
        ASSERT_TRUE(is_next || !excerpt.counts[i]) << frames << ' ' << wanted << ' ' << i;
      }
    }
  }
}

TEST(ValuesAround, AreScaledWithinTheRange) {
  std::int64_t bodies = 200;
  EXPECT_THAT(valuesAround({"bodies", "", &bodies, 60, 1'000'000}, 1),
              ElementsAre("60", "100", "400", "800"));
  double margin = 0.05;
  EXPECT_THAT(valuesAround({"margin", "", &margin, 0, 10}, 1),
              ElementsAre("0.0125", "0.025", "0.1", "0.2"));
  margin = 0;
  EXPECT_THAT(valuesAround({"margin", "", &margin, 0, 10}, 2), ElementsAre("0.02", "0.1", "0.4"));
}

TEST(ValuesAround, AreTheOtherChoices) {
  bool flag = true;
  EXPECT_THAT(valuesAround({"flag", "", &flag}, 1), ElementsAre("off"));
  Choice choice{"b", {"a", "b", "c"}};
  EXPECT_THAT(valuesAround({"choice", "", &choice}, 1), ElementsAre("a", "c"));
  std::string text = "file";
  EXPECT_THAT(valuesAround({"text", "", &text}, 1), IsEmpty());
}

TEST(Repetitions, HoldTheMinimaOfTheFramesThatCountInEachProcess) {
  const Excerpt excerpt{.frames = {0, 1, 5, 6}, .counts = {true, false, true}, .stretches = 2};
  const auto totals = [&](std::vector<double> seconds, std::size_t processes) {
    std::vector<std::vector<std::int64_t>> repetitions;
    for (const Repetition& repetition :
         repetitionsOf({.seconds = std::move(seconds)}, excerpt, processes)) {
      std::vector<std::int64_t>& ns = repetitions.emplace_back();
      for (const FrameTimes& times : repetition.frames) ns.push_back(times[Phase::total]);
    }
    return repetitions;
  };
  const std::vector<double> three_passes = {1e-6, 9, 2e-6, 3e-6, 9, 1e-6, 5e-6, 9, 6e-6};
  EXPECT_THAT(totals(three_passes, 3), ElementsAre(ElementsAre(1000, 2000), ElementsAre(3000, 1000),
                                                   ElementsAre(5000, 6000)));
  EXPECT_THAT(totals(three_passes, 2),
              ElementsAre(ElementsAre(1000, 1000), ElementsAre(5000, 6000)));
  EXPECT_THAT(totals({1e-6, 9, 2e-6}, 2), ElementsAre(ElementsAre(1000, 2000)));
}

/// A finalist that takes `ratio` times the 2 µs of the first.
Finalist finalistOf(const std::string& name, Estimate ratio = {1, {1, 1}}) {
  return {.test_case = caseNamed(name, {}),
          .ratio = {.before = 2e-6, .after = 2e-6 * ratio.value, .ratio = ratio, .drift = {}}};
}

/// The paragraph without line breaks, and the lines after it.
std::string textOf(const Advice& advice) {
  std::string text = adviceText(advice, "game.aabbs --swept");
  std::ranges::replace(text, '\n', ' ');
  return text;
}

TEST(AdviceText, StatesTheFirstTheSecondAndTheLines) {
  Advice advice{.answer = AnswerKind::events,
                .threads = 2,
                .finalists = {finalistOf("tide"), finalistOf("kd", {1.5, {1.4, 1.6}}),
                              finalistOf("sap", {3, {2.9, 3.1}})}};
  for (Finalist& finalist : advice.finalists) finalist.test_case.answer = advice.answer;
  const std::string text = textOf(advice);
  for (const char* part :
       {"Events, 2 threads: tide is the fastest, with 2.00 µs a frame.",
        "Second is kd, 3.00 µs, 50.0 % slower (40.0…60.0 %).",
        "Third sap, 6.00 µs, 3.00 times as slow (2.90…3.10).",
        "broadmark --headless game.aabbs --swept --algorithm tide --answer events",
        ".method = broadmark::broadphase::Method::tide", "Answer::events, .threads = 1"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(text, Not(HasSubstr("among")));
}

TEST(AdviceText, AdmitsThatTwoAreLevel) {
  const auto text = [](Estimate ratio) {
    return textOf({.finalists = {finalistOf("kd"), finalistOf("sap", ratio)}});
  };
  EXPECT_THAT(text({1.005, {0.99, 1.015}}),
              AllOf(HasSubstr("kd is among the fastest"), HasSubstr("as fast as it")));
  EXPECT_THAT(text({1.2, {0.9, 1.5}}),
              AllOf(HasSubstr("kd is among the fastest"), HasSubstr("indistinguishable from it")));
  EXPECT_THAT(textOf({.finalists = {finalistOf("kd")}}), HasSubstr("There is no runner-up."));
}

TEST(AdviceText, StatesParametersAndWhatTheyGain) {
  const Advice advice{.finalists = {finalistOf("columns-mt/t4/copy_cost=300")},
                      .untuned = finalistOf("columns-mt/t4", {1.1, {1.05, 1.15}})};
  const std::string text = textOf(advice);
  for (const char* part : {"columns-mt with copy_cost=300 is the fastest",
                           "columns-mt with default parameters is 10.0 % slower (5.0…15.0 %).",
                           "--algorithm columns-mt --threads 4 --param columns-mt:copy_cost=300",
                           "Method::columns", ".threads = 4});  // with default parameters"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(textOf({.finalists = {finalistOf("dbvt-d/margin=0.5")}}),
              AllOf(HasSubstr("setParameters(*broad_phase, {{\"margin\", \"0.5\"}});"),
                    HasSubstr("conservative"), HasSubstr("enlarged by")));
}

TEST(AdviceText, NamesWrongAlgorithms) {
  const std::string text =
      textOf({.finalists = {}, .untuned = {}, .wrong = {"mine: mismatch: frame 3: 1 missed"}});
  EXPECT_THAT(text, AllOf(HasSubstr("no algorithm gave correct answers"),
                          HasSubstr("DISQUALIFIED: mine: mismatch: frame 3")));
}

}  // namespace
}  // namespace broadmark::tests
