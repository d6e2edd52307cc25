// Named readers-writer locks; a waiting writer blocks new readers.

#include "broadmark/exclusive_use.h"

#include <functional>
#include <map>
#include <mutex>
#include <shared_mutex>
#include <string>

namespace broadmark {

struct NamedLock {
  std::mutex entry;  ///< held by a waiting writer, and briefly by each entering thread
  std::shared_mutex state;
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
  const std::lock_guard entering(lock_->entry);
  exclusive ? lock_->state.lock() : lock_->state.lock_shared();
}

template <bool exclusive>
StateUse<exclusive>::~StateUse() {
  if (lock_ == nullptr) return;
  exclusive ? lock_->state.unlock() : lock_->state.unlock_shared();
}

template class StateUse<true>;
template class StateUse<false>;

}  // namespace broadmark
