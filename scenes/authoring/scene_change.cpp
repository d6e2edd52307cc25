// Adding and removing bodies in O(bodies), whatever their ids.

#include "authoring/scene_change.h"

namespace broadmark::scenes {

void BodyPresence::remove(std::vector<AuthoredBody>& bodies) {
  absent_.reserve(ids_->size());
  std::size_t kept = ids_->empty() ? bodies.size() : ids_->front();
  for (std::size_t i = kept; i < bodies.size(); ++i) {
    if (absent_.size() < ids_->size() && (*ids_)[absent_.size()] == i) {
      absent_.push_back(bodies[i]);
    } else {
      bodies[kept++] = bodies[i];
    }
  }
  bodies.resize(kept);
}

void BodyPresence::insert(std::vector<AuthoredBody>& bodies) {
  // From the last id down, so that each body moves once.
  std::size_t left = bodies.size();
  bodies.resize(bodies.size() + absent_.size());
  std::size_t coming = absent_.size();
  for (std::size_t i = bodies.size(); coming > 0;) {
    --i;
    bodies[i] = (*ids_)[coming - 1] == i ? absent_[--coming] : bodies[--left];
  }
  absent_ = {};
}

}  // namespace broadmark::scenes
