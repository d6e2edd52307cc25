// Libraries with process-wide state: who may use it when.
//
// Each such state has a name. Code that changes it, even for the length of a call, holds an
// ExclusiveUse; code that only depends on it holds a SharedUse. LocalHost holds an ExclusiveUse
// around every call into an algorithm whose traits name a state, so algorithms need not do it
// themselves.
#pragma once

#include <string_view>

namespace broadmark {

/// Bullet's gDbvtMargin: the algorithms of the DBVT family exchange it, Bullet's physics reads it.
inline constexpr std::string_view kBulletTreeMargin = "Bullet's tree margin";

/// Per name: a lock, made when it is first used, which lasts as long as the process.
struct NamedLock;

/// While this lives no other thread uses the state of that name; "" stands for no state. Waits
/// until present uses end; SharedUses that come later wait for it. A thread may hold only one use
/// of a name.
class ExclusiveUse {
 public:
  explicit ExclusiveUse(std::string_view name);
  ~ExclusiveUse();
  ExclusiveUse(const ExclusiveUse&) = delete;
  ExclusiveUse& operator=(const ExclusiveUse&) = delete;

 private:
  NamedLock* lock_;
};

/// While this lives no other thread changes the state. Any number of threads may hold one.
class SharedUse {
 public:
  explicit SharedUse(std::string_view name);
  ~SharedUse();
  SharedUse(const SharedUse&) = delete;
  SharedUse& operator=(const SharedUse&) = delete;

 private:
  NamedLock* lock_;
};

}  // namespace broadmark
