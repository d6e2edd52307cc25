// What both parts of the plug-in need before they use PhysX.
#pragma once

#include <PxPhysicsAPI.h>

#include "broadmark/error.h"

namespace broadmark {

/// Deletes PhysX's objects, which release themselves.
struct ReleasePhysX {
  template <class Object>
  void operator()(Object* object) const {
    object->release();
  }
};

/// PhysX's foundation, of which a process has one: for as long as it runs. Throws UnsupportedError
/// when the library has another version than its headers.
inline physx::PxFoundation& physXFoundation() {
  static physx::PxDefaultAllocator allocator;
  static physx::PxDefaultErrorCallback errors;  // prints to standard error
  static physx::PxFoundation* const foundation =
      PxCreateFoundation(PX_PHYSICS_VERSION, allocator, errors);
  if (foundation == nullptr) throw UnsupportedError("PhysX: the library does not fit its headers");
  return *foundation;
}

}  // namespace broadmark
