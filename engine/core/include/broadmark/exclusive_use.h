// Locks for libraries with process-wide state.
//
// Each such state has a name. Code that changes it, even for the length of a call, holds an
// ExclusiveUse; code that only depends on it holds a SharedUse. InProcessExecutor holds an
// ExclusiveUse around every call into an algorithm with traits that name a state, so algorithms
// need not do it themselves.
#pragma once

#include <string_view>

namespace broadmark {

/// Bullet's gDbvtMargin: the algorithms of the DBVT family change it, Bullet's physics reads it.
inline constexpr std::string_view kBulletTreeMargin = "Bullet's tree margin";

/// A lock per name, made at first use; it lasts as long as the process.
struct NamedLock;

/// Holds the lock of that name; "" stands for no state. A thread may hold only one use of a name.
template <bool exclusive>
class StateUse {
 public:
  explicit StateUse(std::string_view name);
  ~StateUse();
  StateUse(const StateUse&) = delete;
  StateUse& operator=(const StateUse&) = delete;

 private:
  NamedLock* lock_;
};

/// While it exists no other thread uses the state. Waits for present uses to end; new SharedUses
/// wait for it.
using ExclusiveUse = StateUse<true>;
/// While it exists no other thread changes the state. Any number of threads may hold one.
using SharedUse = StateUse<false>;

}  // namespace broadmark
