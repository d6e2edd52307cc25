// The text that names the answer shown.
#include "inspector/session/answer_text.h"

#include <gtest/gtest.h>

#include <array>

#include "inspector/helpers.h"

namespace broadmark::tests {
namespace {

constexpr Aabb kUnit{{0, 0, 0, 0}, {1, 1, 1, 0}};
constexpr Aabb kFar{{5, 5, 5, 0}, {6, 6, 6, 0}};

/// Three boxes, of which the first two overlap, without an answer.
Snapshot threeBoxes() {
  Snapshot snapshot;
  snapshot.frame = 4;
  snapshot.boxes = std::make_shared<const std::vector<Aabb>>(std::vector{kUnit, kUnit, kFar});
  return snapshot;
}

TrackReport trackOf(int number, const char* parameter = nullptr) {
  TrackReport track;
  track.spec.number = number;
  track.spec.test_case.algorithm.id = "sap";
  if (parameter != nullptr) track.spec.test_case.parameters = {{"axis", parameter}};
  return track;
}

TEST(AnswerText, AMissedPairIsToldFromBothSides) {
  Snapshot snapshot = threeBoxes();
  snapshot.track = 1;
  snapshot.checked = true;
  snapshot.oracle_pair_count = 1;
  snapshot.difference.missed_count = 1;
  const std::array<std::uint32_t, 2> both = {0, 1};
  const AnswerText text = answerText(snapshot, {trackOf(1)}, 1, both);
  EXPECT_EQ(text.verdict, AnswerText::Verdict::wrong);
  EXPECT_EQ(text.answer, "sap reports 0 pairs");
  EXPECT_EQ(text.comparison, "the oracle finds 1: 1 missed");
  EXPECT_EQ(text.pair, "0-1: sap does not report it, the oracle finds it");
}

TEST(AnswerText, WhatIsRightOrNotComparedSaysSo) {
  Snapshot snapshot = threeBoxes();
  snapshot.track = 1;
  snapshot.pairs = {{0, 1}};
  EXPECT_EQ(answerText(snapshot, {trackOf(1)}, 1, {}).verdict, AnswerText::Verdict::unchecked);
  snapshot.checked = true;
  snapshot.oracle_pair_count = 1;
  const AnswerText text = answerText(snapshot, {trackOf(1)}, 1, {});
  EXPECT_EQ(text.verdict, AnswerText::Verdict::right);
  EXPECT_EQ(text.answer, "sap reports 1 pair");
  EXPECT_EQ(text.comparison, "the oracle finds the same");
  EXPECT_EQ(text.pair, "");
}

TEST(AnswerText, WithoutAnAlgorithmsAnswerItIsTheOracles) {
  Snapshot snapshot = threeBoxes();
  snapshot.pairs = {{0, 1}};
  const AnswerText text = answerText(snapshot, {trackOf(1)}, 1, {});
  EXPECT_EQ(text.verdict, AnswerText::Verdict::oracle);
  EXPECT_EQ(text.answer, "the oracle finds 1 pair");
  EXPECT_EQ(text.comparison, "sap has no answer for frame 4");
  EXPECT_EQ(answerText(snapshot, {trackOf(1)}, 0, {}).comparison, "no algorithm's answer is shown");
  const std::array<std::uint32_t, 2> apart = {1, 2};
  EXPECT_EQ(answerText(snapshot, {}, 0, apart).pair, "1-2: the oracle does not find it");
}

TEST(AnswerText, TwoLanesOfOneAlgorithmAreToldApart) {
  Snapshot snapshot = threeBoxes();
  snapshot.track = 2;
  const std::vector<TrackReport> tracks = {trackOf(1), trackOf(2, "x")};
  EXPECT_EQ(answerText(snapshot, tracks, 2, {}).owner, caseName(tracks[1].spec.test_case));
}

}  // namespace
}  // namespace broadmark::tests
