// Queries by hand-computed answers.

#include "broadmark/queries.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "broadmark/harness/oracle.h"

namespace broadmark {
namespace {

Aabb box(float x, float y, float z, float edge) {
  return {{x, y, z, 0}, {x + edge, y + edge, z + edge, 0}};
}
Query ray(float x, float y, float z, float to_x, float to_y, float to_z) {
  return {box(x, y, z, 0), {to_x, to_y, to_z, 0}};
}

TEST(Queries, RaysEndAtTheirLength) {
  const Aabb target = box(2, 0, 0, 1);
  EXPECT_TRUE(hits(AnswerKind::rays, ray(0, 0.5F, 0.5F, 4, 0, 0), target));
  EXPECT_TRUE(hits(AnswerKind::rays, ray(0, 0.5F, 0.5F, 2, 0, 0), target)) << "touches";
  EXPECT_FALSE(hits(AnswerKind::rays, ray(0, 0.5F, 0.5F, 1.9F, 0, 0), target));
  EXPECT_FALSE(hits(AnswerKind::rays, ray(0, 0.5F, 0.5F, -4, 0, 0), target)) << "behind";
  EXPECT_FALSE(hits(AnswerKind::rays, ray(0, 1.5F, 0.5F, 4, 0, 0), target)) << "beside";
  EXPECT_TRUE(hits(AnswerKind::rays, ray(2.5F, 0.5F, 0.5F, 0, 0, 0), target)) << "starts within";
  EXPECT_TRUE(hits(AnswerKind::rays, ray(1, -1, 0.5F, 2, 2, 0), target)) << "along an edge";
  EXPECT_FALSE(hits(AnswerKind::rays, ray(0, 0, 0, 1, 1, 1), kEmptyBox));
}

TEST(Queries, MovingBoxesTouchWhatTheyPass) {
  const Query sweep{box(0, 0, 0, 1), {4, 0, 0, 0}};
  EXPECT_TRUE(hits(AnswerKind::sweeps, sweep, box(3, 1, 0, 1))) << "its face";
  EXPECT_TRUE(hits(AnswerKind::sweeps, sweep, box(5, 0, 0, 1))) << "at the end";
  EXPECT_FALSE(hits(AnswerKind::sweeps, sweep, box(5.1F, 0, 0, 1)));
  EXPECT_FALSE(hits(AnswerKind::sweeps, sweep, box(3, 1.1F, 0, 1)));
}

TEST(Queries, NearestBodiesMayBeAnyAtEqualDistance) {
  std::vector<Aabb> boxes;
  for (int i = 1; i < 8; ++i) boxes.push_back(box(static_cast<float>(i), 0, 0, 0));
  for (int i = 0; i < 3; ++i) boxes.push_back(box(0, 100, 0, 0));
  boxes.push_back(kEmptyBox);
  const std::vector<Query> queries = {ray(0, 0, 0, 0, 0, 0)};
  EXPECT_EQ(distanceTo(queries[0], boxes[2]), 3);
  const HitBounds found = findHits({AnswerKind::nearest, queries}, boxes);
  EXPECT_EQ(found.certain.size(), 7U);
  EXPECT_EQ(found.possible.size(), 10U);
  EXPECT_EQ(found.min_count, kNearestBodies);

  std::vector<Pair> answer(found.certain);
  const auto difference = [&] {
    const PairRun reported = answer;
    return findDifference({&reported, 1}, found, {1, boxes});
  };
  EXPECT_EQ(difference().missed_count, 1U) << "too few";
  answer.push_back({0, 8});
  EXPECT_FALSE(difference().isMismatch());
  answer.push_back({0, 10});
  EXPECT_EQ(difference().false_count, 1U) << "an absent body";
  answer.back() = {0, 8};
  EXPECT_EQ(difference().invalid_count, 1U) << "twice";
  answer = {found.possible.begin() + 1, found.possible.begin() + 9};
  EXPECT_EQ(difference().missed_count, 1U) << "not the nearest";
}

TEST(Queries, AreTheSameForTheSameFrame) {
  const std::vector<Aabb> boxes = {box(0, 0, 0, 1), kEmptyBox, box(5, 5, 5, 1)};
  const auto starts = [&](Answer answer, std::uint32_t frame) {
    std::vector<Aabb> all;
    for (const Query& query : makeQueries(answer, boxes, frame)) all.push_back(query.box);
    return all;
  };
  const Answer answer(AnswerKind::rays, 20);
  EXPECT_EQ(starts(answer, 3).size(), 20U);
  EXPECT_EQ(starts(answer, 3), starts(answer, 3));
  EXPECT_NE(starts(answer, 3), starts(answer, 4));
  EXPECT_NE(starts(answer, 3), starts({AnswerKind::nearest, 20}, 3));
  EXPECT_TRUE(makeQueries(answer, std::vector<Aabb>{kEmptyBox}, 1).empty());
}

TEST(Queries, HaveNames) {
  EXPECT_EQ(answerName({AnswerKind::rays, 1000}), "rays:1000");
  EXPECT_EQ(findAnswer("rays:1000"), Answer(AnswerKind::rays, 1000));
  EXPECT_EQ(findAnswer("events"), Answer(AnswerKind::events));
  for (const char* wrong : {"rays", "rays:", "rays:0", "rays:1.5", "rays:-1", "rays:99999999999",
                            "events:3", "teapots:3", ""}) {
    EXPECT_FALSE(findAnswer(wrong)) << wrong;
  }
}

}  // namespace
}  // namespace broadmark
