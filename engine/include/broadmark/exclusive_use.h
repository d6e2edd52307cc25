// Libraries with process-wide state: who may use it when.
//
// A name stands for such a state. Whoever changes it, even for the length of a call, holds an
// ExclusiveUse; whoever only depends on it holds a SharedUse. CaseRun holds the former around every
// call into an algorithm whose traits name a state, so an algorithm need not do it itself.
#pragma once

#include <string_view>

namespace broadmark {

/// Bullet's gDbvtMargin: the algorithms of the DBVT family exchange it, Bullet's physics reads it.
inline constexpr std::string_view kBulletTreeMargin = "Bullet's tree margin";

/// Per name: a lock, made when it is first used, which lasts as long as the process.
struct NamedLock;

/// While this lives nobody else uses the state of that name; "" stands for none. Waits for its
/// turn, which comes before that of later SharedUses. Not reentrant: a thread holds one at most.
class ExclusiveUse {
 public:
  explicit ExclusiveUse(std::string_view name);
  ~ExclusiveUse();
  ExclusiveUse(const ExclusiveUse&) = delete;
  ExclusiveUse& operator=(const ExclusiveUse&) = delete;

 private:
  NamedLock* lock_;
};

/// While this lives nobody changes the state; any number may read it at the same time.
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
