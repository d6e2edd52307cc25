// Numbers without gaps, and back.

#include "compacted_world.h"

#include <algorithm>
#include <utility>

namespace broadmark {

CompactedWorld::CompactedWorld(std::unique_ptr<BroadPhase> algorithm)
    : algorithm_(std::move(algorithm)) {}

void CompactedWorld::visitParameters(const ParameterVisitor& visit) {
  algorithm_->visitParameters(visit);
}

void CompactedWorld::initialize(const SceneInfo& scene, const Frame& first, Execution& execution) {
  team_ = &execution.team();
  filter_ = scene.filter;
  boxes_.reserve(scene.objects);
  bodies_.reserve(scene.objects);
  changed_.reserve(scene.objects);
  places_.assign(scene.objects, kAbsent);
  for (std::uint32_t body = 0; body < first.boxes.size(); ++body) place(body, first.boxes[body]);
  changed_.clear();
  SceneInfo compacted = scene;
  compacted.all_present = true;
  compacted.filter = {};
  algorithm_->initialize(compacted, {first.index, boxes_, changed_}, execution);
}

void CompactedWorld::updateObjects(const Frame& frame) {
  takeOver(frame);
  algorithm_->updateObjects({frame.index, boxes_, changed_});
}

void CompactedWorld::takeOver(const Frame& frame) {
  changed_.clear();
  // Those that vanish first: then no place is left for good, and none is taken twice.
  for (const std::uint32_t body : *frame.changed) {
    if (isEmpty(frame.boxes[body]) && places_[body] != kAbsent) remove(places_[body]);
  }
  for (const std::uint32_t body : *frame.changed) {
    if (!isEmpty(frame.boxes[body])) place(body, frame.boxes[body]);
  }
  std::ranges::sort(changed_);
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  std::erase_if(changed_, [this](std::uint32_t place) { return place >= boxes_.size(); });
}

void CompactedWorld::place(std::uint32_t body, const Aabb& box) {
  if (isEmpty(box)) return;
  if (places_[body] == kAbsent) {
    places_[body] = static_cast<std::uint32_t>(boxes_.size());
    boxes_.push_back(box);
    bodies_.push_back(body);
  }
  boxes_[places_[body]] = box;
  changed_.push_back(places_[body]);
}

/// The last one takes the place.
void CompactedWorld::remove(std::uint32_t place) {
  places_[bodies_[place]] = kAbsent;
  const std::uint32_t last = bodies_.back();
  if (last != bodies_[place]) {
    bodies_[place] = last;
    boxes_[place] = boxes_.back();
    places_[last] = place;
    changed_.push_back(place);
  }
  bodies_.pop_back();
  boxes_.pop_back();
}

void CompactedWorld::cleanCache() {
  for (PairBuffer& pairs : pairs_) pairs.clear();
  runs_.clear();
  algorithm_->cleanCache();
}

void CompactedWorld::searchOverlaps() {
  algorithm_->searchOverlaps();
  const PairRuns found = algorithm_->overlaps();
  if (pairs_.size() < found.size()) pairs_.resize(found.size());
  team_->run([&](int worker) {
    const auto [begin, end] = share(found.size(), team_->size(), worker);
    for (std::size_t run = begin; run < end; ++run) translate(found[run], pairs_[run]);
  });
  runs_.clear();
  for (std::size_t run = 0; run < found.size(); ++run) runs_.push_back(pairs_[run].run());
}

void CompactedWorld::translate(PairRun found, PairBuffer& wanted) const {
  wanted.clear();
  Pair* const room = wanted.room(found.size());
  std::size_t count = 0;
  for (const Pair pair : found) {
    if (pair.a >= pair.b || pair.b >= bodies_.size()) [[unlikely]] {
      room[count++] = {kAbsent, kAbsent};  // as wrong as it was
      continue;
    }
    const Pair bodies = orderedPair(bodies_[pair.a], bodies_[pair.b]);
    room[count] = bodies;
    count += filter_.wanted(bodies.a, bodies.b) ? 1 : 0;
  }
  wanted.advance(count);
}

void CompactedWorld::visitCounters(const CounterVisitor& visit) const {
  visit("bodies present", boxes_.size());
  algorithm_->visitCounters(visit);
}

std::string CompactedWorld::validate() const {
  for (std::size_t place = 0; place < bodies_.size(); ++place) {
    if (places_[bodies_[place]] != place) return "a body is not where it is said to be";
  }
  return algorithm_->validate();
}

}  // namespace broadmark
