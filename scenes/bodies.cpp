#include "broadmark/scenes/bodies.h"

#include <algorithm>
#include <utility>

namespace broadmark::scenes {

Bodies::Bodies(PhysicsEngine& engine, const SceneInfo& scene)
    : engine_(&engine),
      initial_filter_(scene.filter),
      filter_(scene.filter),
      filter_changes_(scene.filter_changes),
      bodies_(scene.objects),
      masses_(scene.objects),
      boxes_(scene.objects, kEmptyBox),
      poses_(scene.objects) {}

std::span<const std::uint32_t> Bodies::inEngine() {
  if (!added_.empty()) {
    std::ranges::sort(added_);
    const auto old_count = static_cast<std::ptrdiff_t>(ids_.size());
    ids_.insert(ids_.end(), added_.begin(), added_.end());
    std::inplace_merge(ids_.begin(), ids_.begin() + old_count, ids_.end());
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
    added_.clear();
  }
  return ids_;
}

PhysicsBody& Bodies::add(std::size_t id, BodyDescription description) {
  const BodyGroups groups = initial_filter_.groupsOf(static_cast<std::uint32_t>(id));
  description.layer = groups.layer;
  description.world = groups.world;
  bodies_[id] = &engine_->addBody(description);
  masses_[id] = description.mass;
  added_.push_back(static_cast<std::uint32_t>(id));
  return *bodies_[id];
}

void Bodies::remove(std::size_t id) {
  if (bodies_[id] == nullptr) return setScenery(id, kEmptyBox);
  engine_->removeBody(*bodies_[id]);
  bodies_[id] = nullptr;
}

void Bodies::place(std::size_t id, const Shape& shape, const Pose& pose) {
  setScenery(id, tightBox(shape, pose));
  poses_[id] = pose;
}

void Bodies::setScenery(std::size_t id, const Aabb& box) {
  boxes_[id] = box;
  changed_scenery_.push_back(static_cast<std::uint32_t>(id));
}

void Bodies::setLayer(std::size_t id, std::uint8_t layer) {
  new_layers_[static_cast<std::uint32_t>(id)] = layer;
}

void Bodies::applyLayers() {
  filter_changed_.clear();
  std::vector<BodyGroups> groups;
  for (const auto& [id, layer] : new_layers_) {
    BodyGroups body = filter_.groupsOf(id);
    if (std::exchange(body.layer, layer) == layer) continue;
    filter_changed_.push_back(id);
    groups.push_back(body);
  }
  new_layers_.clear();
  if (!groups.empty()) filter_ = filter_.with(filter_changed_, groups, size());
}

Frame Bodies::record(std::uint32_t frame) {
  if (filter_changes_) applyLayers();
  changed_.clear();
  for (const std::uint32_t id : inEngine()) {
    Aabb box = kEmptyBox;
    if (const PhysicsBody* body = bodies_[id]) {
      poses_[id] = body->pose();
      box = tightBox(body->shape(), poses_[id]);
    }
    if (!sameBits(box, boxes_[id])) changed_.push_back(id);
    boxes_[id] = box;
  }
  std::erase_if(ids_, [this](std::uint32_t id) { return bodies_[id] == nullptr; });
  if (!changed_scenery_.empty()) {
    changed_.insert(changed_.end(), changed_scenery_.begin(), changed_scenery_.end());
    changed_scenery_.clear();
    std::ranges::sort(changed_);
  }
  if (frame == 0) changed_.clear();
  return {frame, boxes_, changed_, filter_changes_ ? &filter_ : nullptr, filter_changed_};
}

}  // namespace broadmark::scenes
