// The oracle: brute force for few bodies, an exact sweep for many (broadmark/reference_pairs.h).

#include "broadmark/harness/oracle.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "broadmark/error.h"

namespace broadmark {
namespace {

constexpr std::size_t kBruteForceLimit = 100;  // above, the sweep is faster

/// Counts every difference and lists the first of each kind.
void recordPair(std::uint64_t& count, std::vector<Pair>& listed, Pair pair) {
  ++count;
  if (listed.size() < FrameDifference::kMaxListed) listed.push_back(pair);
}

/// The hash of everything that decides which pairs are correct.
HashValue keyOf(std::span<const Aabb> boxes, const CollisionFilter& filter,
                const PeriodicBox& periodic) {
  Hasher hasher;
  hasher.add(std::as_bytes(boxes));
  if (periodic.repeats()) hasher.add(std::as_bytes(std::span(&periodic, 1)));
  if (filter.wantsAll()) return hasher.value();
  const LayerMatrix matrix = filter.matrix();
  const std::array<std::size_t, 3> sizes = {filter.layers().size(), filter.worlds().size(),
                                            filter.tags().size()};
  hasher.add(std::as_bytes(std::span(matrix.rows())));
  hasher.add(std::as_bytes(std::span(sizes)));
  hasher.add(std::as_bytes(filter.layers()));
  hasher.add(std::as_bytes(filter.worlds()));
  hasher.add(std::as_bytes(filter.tags()));
  return hasher.value();
}

}  // namespace

Oracle::PairAnswer& Oracle::find(std::span<const Aabb> boxes, const CollisionFilter& filter,
                                 const PeriodicBox& periodic, bool with_pairs) {
  const HashValue key = keyOf(boxes, filter, periodic);
  const auto cached = answers_.find(key);
  if (cached != answers_.end() && (cached->second.pairs || !with_pairs)) return cached->second;
  scratch_ = boxes.size() <= kBruteForceLimit
                 ? bruteForcePairs(boxes, filter, periodic)
                 : sweptPairs(boxes, filter, periodic, max_pairs_, cancelled_);
  PairAnswer& answer = answers_[key];
  const PairRun pairs = scratch_;
  answer.digest = digest({&pairs, 1});
  const std::size_t bytes = scratch_.size() * sizeof(Pair);
  if (bytes <= budget_bytes_) {
    budget_bytes_ -= bytes;
    answer.pairs.emplace(scratch_.begin(), scratch_.end());
  }
  return answer;
}

std::span<const Pair> Oracle::pairs(std::span<const Aabb> boxes, const CollisionFilter& filter,
                                    const PeriodicBox& periodic) {
  const PairAnswer& answer = find(boxes, filter, periodic, true);
  return answer.pairs ? *answer.pairs : scratch_;
}

PairDigest Oracle::pairDigest(std::span<const Aabb> boxes, const CollisionFilter& filter,
                              const PeriodicBox& periodic) {
  return find(boxes, filter, periodic, false).digest;
}

const HitBounds& Oracle::hits(Answer answer, const Frame& frame) {
  const std::pair key(keyOf(frame.boxes, {}, {}),
                      fmt::format("{}:{}", frame.index, answerName(answer)));
  const auto cached = hits_.find(key);
  if (cached != hits_.end()) return cached->second;
  const std::vector<Query> queries = makeQueries(answer, frame.boxes, frame.index);
  hit_scratch_ = findHits({answer.kind, queries}, frame.boxes);
  const std::size_t bytes =
      (hit_scratch_.certain.size() + hit_scratch_.possible.size()) * sizeof(Pair);
  if (bytes > budget_bytes_) return hit_scratch_;
  budget_bytes_ -= bytes;
  return hits_.emplace(key, std::move(hit_scratch_)).first->second;
}

void FrameDifference::addInvalid(PairRun pairs) {
  for (const Pair pair : pairs) recordPair(invalid_count, invalid_pairs, pair);
}

std::string mismatchText(const FrameDifference& difference) {
  return fmt::format("{} missed, {} false, {} invalid", difference.missed_count,
                     difference.false_count, difference.invalid_count);
}

FrameDifference findDifference(PairRuns answer, const HitBounds& hits, const Frame& frame) {
  FrameDifference difference{.frame = frame.index};
  std::vector<Pair> reported;
  for (const PairRun chunk : answer) reported.insert(reported.end(), chunk.begin(), chunk.end());
  std::ranges::sort(reported);
  for (std::size_t i = 1; i < reported.size(); ++i) {
    if (reported[i] != reported[i - 1]) continue;
    recordPair(difference.invalid_count, difference.invalid_pairs, reported[i]);
  }
  reported.erase(std::unique(reported.begin(), reported.end()), reported.end());
  std::vector<Pair> wrong;
  std::vector<Pair> missed;
  std::ranges::set_difference(reported, hits.possible, std::back_inserter(wrong));
  std::ranges::set_difference(hits.certain, reported, std::back_inserter(missed));
  for (const Pair hit : wrong) recordPair(difference.false_count, difference.false_pairs, hit);
  for (const Pair hit : missed) recordPair(difference.missed_count, difference.missed_pairs, hit);
  const std::uint64_t found = reported.size() - wrong.size() + missed.size();
  if (found < hits.min_count) difference.missed_count += hits.min_count - found;
  return difference;
}

FrameDifference findDifference(PairRuns answer, std::span<const Pair> correct, const Frame& frame,
                               float margin, const CollisionFilter& filter,
                               const PeriodicBox& periodic) {
  FrameDifference difference{.frame = frame.index};
  std::vector<Pair> reported;
  reported.reserve(pairCount(answer));
  for (const PairRun chunk : answer) {
    for (const Pair pair : chunk) {
      if (pair.a < pair.b && pair.b < frame.boxes.size()) {
        reported.push_back(pair);
      } else {
        recordPair(difference.invalid_count, difference.invalid_pairs, pair);
      }
    }
  }
  std::ranges::sort(reported);

  auto expected = correct.begin();
  for (std::size_t i = 0; i < reported.size(); ++i) {
    const Pair pair = reported[i];
    if (i > 0 && pair == reported[i - 1]) {
      ++difference.duplicate_count;
      recordPair(difference.invalid_count, difference.invalid_pairs, pair);
      continue;
    }
    for (; expected != correct.end() && *expected < pair; ++expected) {
      recordPair(difference.missed_count, difference.missed_pairs, *expected);
    }
    if (expected != correct.end() && *expected == pair) {
      ++expected;
      continue;
    }
    if (filter.wanted(pair.a, pair.b) &&
        overlaps(frame.boxes[pair.a], frame.boxes[pair.b], periodic, margin)) {
      recordPair(difference.allowed_extra_count, difference.allowed_extra_pairs, pair);
    } else {
      recordPair(difference.false_count, difference.false_pairs, pair);
    }
  }
  for (; expected != correct.end(); ++expected) {
    recordPair(difference.missed_count, difference.missed_pairs, *expected);
  }
  return difference;
}

}  // namespace broadmark
