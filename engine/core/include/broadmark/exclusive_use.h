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

/// One lock per name, created at first use and never destroyed.
struct NamedLock;

/// Holds the lock of that name; "": no lock. A thread may hold only one use of a name.
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

/// Excludes all other uses of the state. The constructor waits for present uses to end; new
/// SharedUses wait meanwhile.
using ExclusiveUse = StateUse<true>;
/// Excludes changes of the state. Any number of threads may hold one.
using SharedUse = StateUse<false>;

}  // namespace broadmark
