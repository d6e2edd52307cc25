// Named readers-writer locks; a waiting writer blocks new readers.

#include "broadmark/exclusive_use.h"

#include <functional>
#include <map>
#include <mutex>
#include <shared_mutex>
#include <string>

namespace broadmark {

struct NamedLock {
  std::mutex door;  ///< held by a waiting writer, and briefly by every thread that enters
  std::shared_mutex room;
};

namespace {

NamedLock* lockOf(std::string_view name) {
  if (name.empty()) return nullptr;
  static std::mutex guard;
  static std::map<std::string, NamedLock, std::less<>> locks;
  const std::lock_guard hold(guard);
  return &locks[std::string(name)];
}

}  // namespace

template <bool exclusive>
StateUse<exclusive>::StateUse(std::string_view name) : lock_(lockOf(name)) {
  if (lock_ == nullptr) return;
  const std::lock_guard entering(lock_->door);
  exclusive ? lock_->room.lock() : lock_->room.lock_shared();
}

template <bool exclusive>
StateUse<exclusive>::~StateUse() {
  if (lock_ == nullptr) return;
  exclusive ? lock_->room.unlock() : lock_->room.unlock_shared();
}

template class StateUse<true>;
template class StateUse<false>;

}  // namespace broadmark
