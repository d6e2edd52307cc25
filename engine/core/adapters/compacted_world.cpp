// Numbers without gaps, and back.

#include "adapters/compacted_world.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "adapters/renamed_bodies.h"
#include "broadmark/adapters.h"

namespace broadmark {

CompactedWorld::CompactedWorld(std::unique_ptr<BroadPhase> algorithm)
    : algorithm_(std::move(algorithm)) {}

void CompactedWorld::visitParameters(const ParameterVisitor& visit) {
  algorithm_->visitParameters(visit);
}

void CompactedWorld::initialize(const SceneInfo& scene, const Frame& first, Execution& execution) {
  team_ = &execution.team();
  margin_ = algorithm_->margin();
  filter_ = scene.filter;
  matrix_ = filter_.matrix();
  std::vector<std::uint32_t> all(scene.objects);
  std::iota(all.begin(), all.end(), 0U);
  findStrangers(scene, all);
  worlds_.emplace(scene);
  present_.assign(scene.objects, 0);
  places_.assign(scene.objects, kAbsent);
  boxes_.reserve(scene.objects);
  if (worlds_->moves()) true_boxes_.reserve(scene.objects);
  bodies_.reserve(scene.objects);
  changed_.reserve(scene.objects);
  appearing_.reserve(scene.objects);
  takeOver({first.index, first.boxes, all});
  changed_.clear();
  SceneInfo compacted = scene;
  compacted.all_present = true;
  compacted.filter = {};
  compacted.world = worlds_->world();
  algorithm_->initialize(compacted, {first.index, boxes_, changed_}, execution);
}

void CompactedWorld::findStrangers(const SceneInfo& scene, std::span<const std::uint32_t> bodies) {
  const NonCollidingLayers strangers(filter_, bodies);
  const auto meeting = static_cast<std::size_t>(std::ranges::count_if(
      bodies, [&](std::uint32_t body) { return strangers.collideWith(body); }));
  if (strangers.bodyCount() < meeting) return;  // to look who is near would cost more than it saves
  strangers_ = strangers;
  for (const std::uint32_t body : bodies) {
    if (strangers_.contains(body)) stranger_bodies_.push_back(body);
    if (strangers_.collideWith(body)) meeting_bodies_.push_back(body);
  }
  near_.emplace(scene.world);
}

void CompactedWorld::updateObjects(const Frame& frame) {
  takeOver(frame);
  algorithm_->updateObjects({frame.index, boxes_, changed_});
}

void CompactedWorld::takeOver(const Frame& frame) {
  changed_.clear();
  appearing_.clear();
  if (frame.changed->empty()) return;
  const bool layers_changed = countPresent(frame);
  markMeeting(frame);
  // Those that go first: then no place is left for good, and none is taken twice.
  for (const std::uint32_t body : *frame.changed) consider(body, frame.boxes[body]);
  for (const std::uint32_t body : stranger_bodies_) consider(body, frame.boxes[body]);
  if (layers_changed) {
    for (std::uint32_t body = 0; body < places_.size(); ++body) consider(body, frame.boxes[body]);
  }
  for (const std::uint32_t body : appearing_) place(body, frame.boxes[body]);
  for (const std::uint32_t body : *frame.changed) {
    if (places_[body] != kAbsent) place(body, frame.boxes[body]);
  }
  std::ranges::sort(changed_);
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  std::erase_if(changed_, [this](std::uint32_t place) { return place >= boxes_.size(); });
}

/// Whether a layer has got somebody to meet, or has nobody any more.
bool CompactedWorld::countPresent(const Frame& frame) {
  for (const std::uint32_t body : *frame.changed) {
    const std::uint8_t is_there = isEmpty(frame.boxes[body]) ? 0 : 1;
    population_[filter_.layerOf(body)] += is_there;
    population_[filter_.layerOf(body)] -= std::exchange(present_[body], is_there);
  }
  const std::uint32_t before = std::exchange(meetable_, 0);
  for (std::size_t layer = 0; layer < LayerMatrix::kLayers; ++layer) {
    for (std::size_t other = 0; other < LayerMatrix::kLayers; ++other) {
      const bool meet = matrix_.collide(layer, other) && population_[other] > 0;
      meetable_ |= std::uint32_t{meet} << layer;
    }
  }
  return meetable_ != before;
}

void CompactedWorld::markMeeting(const Frame& frame) {
  if (stranger_bodies_.empty()) return;
  near_->clear();
  for (const std::uint32_t body : meeting_bodies_) {
    if (present_[body] != 0) near_->mark(frame.boxes[body]);
  }
}

bool CompactedWorld::takesPart(std::uint32_t body, const Aabb& box) {
  if (present_[body] == 0 || (meetable_ >> filter_.layerOf(body) & 1) == 0) return false;
  return !strangers_.contains(body) || near_->isNear(box);
}

void CompactedWorld::consider(std::uint32_t body, const Aabb& box) {
  const bool took_part = places_[body] != kAbsent;
  if (took_part == takesPart(body, box)) return;
  if (took_part) {
    remove(places_[body]);
  } else {
    appearing_.push_back(body);
  }
}

void CompactedWorld::place(std::uint32_t body, const Aabb& box) {
  if (places_[body] == kAbsent) {
    places_[body] = static_cast<std::uint32_t>(boxes_.size());
    boxes_.emplace_back();
    if (worlds_->moves()) true_boxes_.emplace_back();
    bodies_.push_back(body);
  }
  const std::uint32_t place = places_[body];
  boxes_[place] = worlds_->moves() ? worlds_->moved(body, box) : box;
  if (worlds_->moves()) true_boxes_[place] = box;
  changed_.push_back(place);
}

/// The last one takes the place.
void CompactedWorld::remove(std::uint32_t place) {
  places_[bodies_[place]] = kAbsent;
  const std::uint32_t last = bodies_.back();
  if (last != bodies_[place]) {
    bodies_[place] = last;
    boxes_[place] = boxes_.back();
    if (worlds_->moves()) true_boxes_[place] = true_boxes_.back();
    places_[last] = place;
    changed_.push_back(place);
  }
  bodies_.pop_back();
  boxes_.pop_back();
  if (worlds_->moves()) true_boxes_.pop_back();
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
  team_->run(found.size(), [&](int, Range runs) {
    for (std::size_t run = runs.begin; run < runs.end; ++run) translate(found[run], pairs_[run]);
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
    count += isWanted(pair, bodies) ? 1 : 0;
  }
  wanted.advance(count);
}

/// Boxes that were moved apart from others may have been rounded until they met.
bool CompactedWorld::isWanted(Pair places, Pair bodies) const {
  if (!filter_.wanted(bodies.a, bodies.b)) return false;
  return !worlds_->moves() || broadmark::overlaps(enlarged(true_boxes_[places.a], margin_),
                                                  enlarged(true_boxes_[places.b], margin_));
}

void CompactedWorld::visitCounters(const CounterVisitor& visit) const {
  visit("bodies taking part", boxes_.size());
  algorithm_->visitCounters(visit);
}

void CompactedWorld::drawStructure(DebugDraw& draw) const {
  RenamedBodies renamed(draw, bodies_);
  algorithm_->drawStructure(renamed);
}

std::string CompactedWorld::validate() const {
  for (std::size_t place = 0; place < bodies_.size(); ++place) {
    if (places_[bodies_[place]] != place) return "a body is not where it is said to be";
  }
  return algorithm_->validate();
}

bool isChangingWorld(const SceneInfo& scene) {
  return !scene.all_present || !scene.filter.wantsAll();
}

std::unique_ptr<BroadPhase> compacted(std::unique_ptr<BroadPhase> algorithm) {
  return std::make_unique<CompactedWorld>(std::move(algorithm));
}

}  // namespace broadmark
