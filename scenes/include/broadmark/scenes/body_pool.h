// Storage for an engine's bodies, with stable addresses and reuse of memory. Adding and removing
// take constant time.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace broadmark::scenes {

template <class Body>
class BodyPool {
 public:
  template <class... Arguments>
  Body& add(Arguments&&... arguments) {
    if (free_.empty()) {
      free_.push_back(slots_.size());
      slots_.emplace_back();
    }
    const std::size_t slot = free_.back();
    free_.pop_back();
    return slots_[slot].emplace(slot, std::forward<Arguments>(arguments)...);
  }

  /// The body must be in this pool.
  void remove(Body& body) {
    const std::size_t slot = static_cast<Slotted&>(body).slot;
    slots_[slot].reset();
    free_.push_back(slot);
  }

  /// Calls visit(body) for each body, in slot order.
  template <class Visit>
  void each(const Visit& visit) {
    for (auto& slot : slots_) {
      if (slot) visit(static_cast<Body&>(*slot));
    }
  }

  /// Whether holds(body) for all bodies.
  template <class Holds>
  [[nodiscard]] bool all(const Holds& holds) const {
    for (const auto& slot : slots_) {
      if (slot && !holds(static_cast<const Body&>(*slot))) return false;
    }
    return true;
  }

 private:
  struct Slotted final : Body {
    template <class... Arguments>
    explicit Slotted(std::size_t index, Arguments&&... arguments)
        : Body(std::forward<Arguments>(arguments)...), slot(index) {}
    std::size_t slot;
  };

  std::deque<std::optional<Slotted>> slots_;
  std::vector<std::size_t> free_;  ///< slots without a body
};

}  // namespace broadmark::scenes
