// Libraries with process-wide state: who may use it when.
//
// Each such state has a name. Code that changes it, even for the length of a call, holds an
// ExclusiveUse; code that only depends on it holds a SharedUse. InProcessExecutor holds an
// ExclusiveUse around every call into an algorithm whose traits name a state, so algorithms need
// not do it themselves.
#pragma once

#include <string_view>

namespace broadmark {

/// Bullet's gDbvtMargin: the algorithms of the DBVT family exchange it, Bullet's physics reads it.
inline constexpr std::string_view kBulletTreeMargin = "Bullet's tree margin";

/// Per name: a lock, made when it is first used, which lasts as long as the process.
struct NamedLock;

/// One of a state of that name; "" stands for no state. A thread may hold only one use of a name.
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

/// While this lives no other thread uses the state. Waits until present uses end; SharedUses that
/// come later wait for it.
using ExclusiveUse = StateUse<true>;
/// While this lives no other thread changes the state. Any number of threads may hold one.
using SharedUse = StateUse<false>;

}  // namespace broadmark
