#include "tide/candidate_pairs.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "corner.h"
#include "prefetch.h"

namespace broadmark::tide {
namespace {

constexpr std::size_t kBlock = 1024;  ///< candidates per batch of written pairs

bool isWithin(const Aabb& box, const Aabb& fat_box) {
  return isEveryAxis((cornerOf(box.min) >= cornerOf(fat_box.min)) &
                     (cornerOf(box.max) <= cornerOf(fat_box.max)));
}

std::uint32_t overlap(const Aabb& a, const Aabb& b) { return overlapOnAxes(a, b) ? 1 : 0; }

/// An absent body has no fat box.
Aabb fatBoxOf(const Aabb& box, float margin) {
  if (isEmpty(box)) return box;
  constexpr float kLargest = std::numeric_limits<float>::max();
  Aabb fat_box = enlarged(box, margin);
  for (int axis = 0; axis < 3; ++axis) {
    fat_box.min[axis] = std::max(fat_box.min[axis], -kLargest);
    fat_box.max[axis] = std::min(fat_box.max[axis], kLargest);
  }
  return fat_box;
}

}  // namespace

CandidatePairs::CandidatePairs(std::unique_ptr<BroadPhase> search, const SceneInfo& scene,
                               const Frame& frame, ExecutionContext& execution)
    : search_(std::move(search)),
      bodies_(frame.boxes.size()),
      boxes_(frame.boxes.size()),
      before_(frame.boxes.size()),
      fat_boxes_(frame.boxes.size()) {
  std::iota(bodies_.begin(), bodies_.end(), 0U);
  constexpr std::span<const std::uint32_t> kNone;
  search_->initialize(scene, {.index = 0, .boxes = frame.boxes, .changed = kNone}, execution);
}

void CandidatePairs::start(std::span<const Aabb> boxes, float margin) {
  boxes_.assign(boxes.begin(), boxes.end());
  before_ = boxes_;
  for (std::size_t i = 0; i < boxes.size(); ++i) fat_boxes_[i] = fatBoxOf(boxes[i], margin);
}

bool CandidatePairs::move(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!isWithin(boxes[bodies[i]], fat_boxes_[bodies[i]])) return false;
  }
  for (const std::uint32_t body : bodies) {
    boxes_[body] = boxes[body];
    if (isEmpty(boxes[body])) fat_boxes_[body] = boxes[body];  // as in search()
  }
  return true;
}

void CandidatePairs::restart(std::span<const Aabb> boxes, float margin) {
  std::swap(before_, boxes_);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    boxes_[i] = boxes[i];
    fat_boxes_[i] = fatBoxOf(merged(before_[i], boxes[i]), margin);
  }
}

void CandidatePairs::search() {
  search_->updateObjects({.index = ++searches_, .boxes = fat_boxes_, .changed = bodies_});
  search_->cleanCache();
  search_->updateStructures();
  search_->searchOverlaps();
  // Candidates with an absent body serve its ended pairs only: it may come back with another
  // filter.
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (isEmpty(boxes_[i])) fat_boxes_[i] = boxes_[i];
  }
  candidates_.resize(pairCount(search_->overlaps()));
  Candidate* to = candidates_.data();
  for (const PairRun run : search_->overlaps()) {
    for (const Pair pair : run) {
      *to++ = {pair.a, pair.b | (overlap(before_[pair.a], before_[pair.b]) * kOverlaps)};
    }
  }
}

void CandidatePairs::findPairs(PairBuffer& pairs) const {
  const Candidate* const candidates = candidates_.data();
  for (std::size_t first = 0; first < size(); first += kBlock) {
    const std::size_t end = std::min(first + kBlock, size());
    Pair* to = pairs.room(kBlock);
    const Pair* const begin = to;
    for (std::size_t i = first; i < end; ++i) {
      const Candidate ahead = candidates[std::min(i + kPrefetchDistance, size() - 1)];
      prefetch(&boxes_[ahead.a]);
      prefetch(&boxes_[ahead.b & ~kOverlaps]);
      const Pair pair{candidates[i].a, candidates[i].b & ~kOverlaps};
      *to = pair;
      to += overlap(boxes_[pair.a], boxes_[pair.b]);
    }
    pairs.advance(static_cast<std::size_t>(to - begin));
  }
}

void CandidatePairs::findEvents(PairBuffer& began, PairBuffer& ended) {
  Candidate* const candidates = candidates_.data();
  for (std::size_t first = 0; first < size(); first += kBlock) {
    const std::size_t end = std::min(first + kBlock, size());
    Pair* const begins = began.room(kBlock);
    Pair* const ends = ended.room(kBlock);
    std::size_t began_count = 0;
    std::size_t ended_count = 0;
    for (std::size_t i = first; i < end; ++i) {
      const Candidate ahead = candidates[std::min(i + kPrefetchDistance, size() - 1)];
      prefetch(&boxes_[ahead.a]);
      prefetch(&boxes_[ahead.b & ~kOverlaps]);
      const Pair pair{candidates[i].a, candidates[i].b & ~kOverlaps};
      const std::uint32_t now = overlap(boxes_[pair.a], boxes_[pair.b]);
      const std::uint32_t before = candidates[i].b / kOverlaps;
      candidates[i].b = pair.b | (now * kOverlaps);
      begins[began_count] = ends[ended_count] = pair;
      began_count += now & ~before;
      ended_count += before & ~now;
    }
    began.advance(began_count);
    ended.advance(ended_count);
  }
}

void CandidatePairs::draw(DebugDraw& draw) const {
  for (const Aabb& fat_box : fat_boxes_) {
    if (!isEmpty(fat_box)) draw.box(fat_box, StructureRole::cell, 0);
  }
  for (std::uint32_t body = 0; body < boxes_.size(); ++body) draw.tests(body, 0);
  for (const Candidate candidate : candidates_) {
    draw.tests(candidate.a, 1);
    draw.tests(candidate.b & ~kOverlaps, 1);
  }
}

std::string CandidatePairs::validate() const {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (!isEmpty(boxes_[i]) && !isWithin(boxes_[i], fat_boxes_[i]))
      return "a body extends beyond its fat box";
  }
  return search_->validate();
}

}  // namespace broadmark::tide
