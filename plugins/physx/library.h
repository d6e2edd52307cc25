// Initialises PhysX for both parts of the plug-in, and for benchmarks.
#pragma once

#include <PxPhysicsAPI.h>

#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "broadmark/error.h"

namespace broadmark {

/// Deleter for PhysX's objects.
struct ReleasePhysX {
  template <class Object>
  void operator()(Object* object) const {
    object->release();
  }
};
template <class Object>
using PhysXPtr = std::unique_ptr<Object, ReleasePhysX>;

/// Stores PhysX's errors, because PhysX continues after most of them with incomplete results.
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
    const std::lock_guard lock(mutex_);
    if (first_.empty()) first_ = message;
  }

  /// Throws std::runtime_error for the first error since the last call, if any.
  void check() {
    const std::lock_guard lock(mutex_);
    if (!first_.empty()) throw std::runtime_error("PhysX: " + std::exchange(first_, {}));
  }

 private:
  std::mutex mutex_;
  std::string first_;
};

/// PhysX's foundation, a singleton that is never released. Throws UnsupportedError if the versions
/// of the library and its headers differ.
inline physx::PxFoundation& physXFoundation() {
  static physx::PxDefaultAllocator allocator;
  static physx::PxFoundation* const foundation =
      PxCreateFoundation(PX_PHYSICS_VERSION, allocator, PhysXErrors::instance());
  if (foundation == nullptr)
    throw UnsupportedError("PhysX: the library does not match its headers");
  return *foundation;
}

/// PhysX's factory, a singleton that is never released.
inline physx::PxPhysics& physXFactory() {
  static physx::PxPhysics* const physics =
      PxCreatePhysics(PX_PHYSICS_VERSION, physXFoundation(), physx::PxTolerancesScale());
  if (physics == nullptr) throw UnsupportedError("PhysX: cannot create the physics object");
  return *physics;
}

}  // namespace broadmark
