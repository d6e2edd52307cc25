// Storage for an engine's bodies, with stable addresses and reuse of memory. Adding and removing
// take constant time.
//
// Example:
//
//   struct Body {
//     explicit Body(double kilograms) : mass(kilograms) {}
//     double mass;
//   };
//   scenes::BodyPool<Body> pool;
//   Body& body = pool.add(2.0);  // stays at its address
//   const bool all_heavy = pool.all([](const Body& other) { return other.mass > 1; });
//   pool.remove(body);
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace broadmark::scenes {

/// Owns the bodies, and destroys them with itself. `Body` is a class that can be derived from. The
/// memory of removed bodies is reused, but not freed. Not thread-safe.
template <class Body>
class BodyPool {
 public:
  /// Constructs a body in the slot that was freed last, or in a new one. The reference is valid
  /// until the body is removed. Amortised O(1).
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

  /// Destroys a body, which must be in this pool. Amortised O(1).
  void remove(Body& body) {
    const std::size_t slot = static_cast<Slotted&>(body).slot;
    slots_[slot].reset();
    free_.push_back(slot);
  }

  /// Calls visit(body) for each body, in slot order; visit() must not add bodies, but may remove
  /// the one it is called with. O(largest number of bodies so far).
  template <class Visit>
  void each(const Visit& visit) {
    for (auto& slot : slots_) {
      if (slot) visit(static_cast<Body&>(*slot));
    }
  }

  /// Whether holds(body) for all bodies; true if there are none. As each(), until the first
  /// failure.
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
