// What both parts of the plug-in need before they use PhysX.
#pragma once

#include <PxPhysicsAPI.h>

#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "broadmark/error.h"

namespace broadmark {

/// Deletes PhysX's objects, which release themselves.
struct ReleasePhysX {
  template <class Object>
  void operator()(Object* object) const {
    object->release();
  }
};

/// PhysX goes on after most errors, with less than was asked for.
class PhysXErrors final : public physx::PxErrorCallback {
 public:
  static PhysXErrors& instance() {
    static PhysXErrors errors;
    return errors;
  }

  void reportError(physx::PxErrorCode::Enum code, const char* message, const char* /*file*/,
                   int /*line*/) override {
    constexpr int kHarmless = physx::PxErrorCode::eDEBUG_INFO | physx::PxErrorCode::eDEBUG_WARNING |
                              physx::PxErrorCode::ePERF_WARNING;
    if ((code & kHarmless) != 0) return;
    const std::lock_guard alone(mutex_);
    if (first_.empty()) first_ = message;
  }

  /// Throws std::runtime_error for the first one since the last call, if there was one.
  void check() {
    const std::lock_guard alone(mutex_);
    if (!first_.empty()) throw std::runtime_error("PhysX: " + std::exchange(first_, {}));
  }

 private:
  std::mutex mutex_;
  std::string first_;
};

/// PhysX's foundation, of which a process has one: for as long as it runs. Throws UnsupportedError
/// when the library has another version than its headers.
inline physx::PxFoundation& physXFoundation() {
  static physx::PxDefaultAllocator allocator;
  static physx::PxFoundation* const foundation =
      PxCreateFoundation(PX_PHYSICS_VERSION, allocator, PhysXErrors::instance());
  if (foundation == nullptr) throw UnsupportedError("PhysX: the library does not fit its headers");
  return *foundation;
}

}  // namespace broadmark
