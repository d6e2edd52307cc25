// Whose answer is shown, in words.
#include "inspector/session/answer_text.h"

#include <gtest/gtest.h>

#include <array>

#include "inspector/helpers.h"

namespace broadmark::tests {
namespace {

constexpr Aabb kUnit{{0, 0, 0, 0}, {1, 1, 1, 0}};
constexpr Aabb kFar{{5, 5, 5, 0}, {6, 6, 6, 0}};

/// Three boxes, of which the first two overlap; nobody's answer yet.
Snapshot threeBoxes() {
  Snapshot snapshot;
  snapshot.frame = 4;
  snapshot.boxes = std::make_shared<const std::vector<Aabb>>(std::vector{kUnit, kUnit, kFar});
  return snapshot;
}

LaneReport laneOf(int number, const char* parameter = nullptr) {
  LaneReport lane;
  lane.spec.number = number;
  lane.spec.run.algorithm.id = "sap";
  if (parameter != nullptr) lane.spec.run.parameters = {{"axis", parameter}};
  return lane;
}

TEST(AnswerText, AMissedPairIsToldFromBothSides) {
  Snapshot snapshot = threeBoxes();
  snapshot.lane = 1;
  snapshot.checked = true;
  snapshot.right_pairs = 1;
  snapshot.difference.missed_count = 1;
  const std::array<std::uint32_t, 2> both = {0, 1};
  const AnswerText text = answerText(snapshot, {laneOf(1)}, 1, both);
  EXPECT_EQ(text.verdict, AnswerText::Verdict::wrong);
  EXPECT_EQ(text.answer, "sap reports 0 pairs");
  EXPECT_EQ(text.beside, "the oracle finds 1: 1 missed");
  EXPECT_EQ(text.pair, "0-1: sap does not report it, the oracle finds it");
}

TEST(AnswerText, WhatIsRightOrNotComparedSaysSo) {
  Snapshot snapshot = threeBoxes();
  snapshot.lane = 1;
  snapshot.pairs = {{0, 1}};
  EXPECT_EQ(answerText(snapshot, {laneOf(1)}, 1, {}).verdict, AnswerText::Verdict::unchecked);
  snapshot.checked = true;
  snapshot.right_pairs = 1;
  const AnswerText text = answerText(snapshot, {laneOf(1)}, 1, {});
  EXPECT_EQ(text.verdict, AnswerText::Verdict::right);
  EXPECT_EQ(text.answer, "sap reports 1 pair");
  EXPECT_EQ(text.beside, "the oracle finds the same");
  EXPECT_EQ(text.pair, "");
}

TEST(AnswerText, WithoutAnAlgorithmsAnswerItIsTheOracles) {
  Snapshot snapshot = threeBoxes();
  snapshot.pairs = {{0, 1}};
  const AnswerText text = answerText(snapshot, {laneOf(1)}, 1, {});
  EXPECT_EQ(text.verdict, AnswerText::Verdict::oracle);
  EXPECT_EQ(text.answer, "the oracle finds 1 pair");
  EXPECT_EQ(text.beside, "sap has no answer for frame 4");
  EXPECT_EQ(answerText(snapshot, {laneOf(1)}, 0, {}).beside, "no algorithm's answer is shown");
  const std::array<std::uint32_t, 2> apart = {1, 2};
  EXPECT_EQ(answerText(snapshot, {}, 0, apart).pair, "1-2: the oracle does not find it");
}

TEST(AnswerText, TwoLanesOfOneAlgorithmAreToldApart) {
  Snapshot snapshot = threeBoxes();
  snapshot.lane = 2;
  const std::vector<LaneReport> lanes = {laneOf(1), laneOf(2, "x")};
  EXPECT_EQ(answerText(snapshot, lanes, 2, {}).owner, caseName(lanes[1].spec.run));
}

}  // namespace
}  // namespace broadmark::tests
