// Initialises Jolt for both parts of the plug-in, and for benchmarks.
#pragma once

#include <Jolt/Jolt.h>
// Must precede Jolt's other headers.
#include <Jolt/RegisterTypes.h>

#include <Jolt/Core/Factory.h>

#include "broadmark/error.h"

namespace broadmark {

/// Must be the first member of a class with Jolt members: registers Jolt's allocator and types,
/// which are global to the process. Throws UnsupportedError if the library was built with other
/// options than the plug-in.
struct JoltLibrary {
  JoltLibrary() {
    static const bool initialised = initialise();
    static_cast<void>(initialised);
  }

 private:
  static bool initialise() {
    if (!JPH::VerifyJoltVersionID()) {
      throw UnsupportedError("Jolt was built with other options than this plug-in");
    }
    JPH::RegisterDefaultAllocator();
    JPH::Factory::sInstance = new JPH::Factory();  // never deleted
    JPH::RegisterTypes();
    return true;
  }
};

}  // namespace broadmark
