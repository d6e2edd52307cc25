// What both parts of the plug-in need before they use Jolt.
#pragma once

#include <Jolt/Jolt.h>
// Jolt's other headers need the one above.
#include <Jolt/RegisterTypes.h>

#include <Jolt/Core/Factory.h>

#include "broadmark/error.h"

namespace broadmark {

/// The first member of whatever has members of Jolt's: sets up what Jolt keeps for the whole
/// process, its allocator and its types. Throws UnsupportedError when the library was built with
/// other options than its headers say.
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
    JPH::Factory::sInstance = new JPH::Factory();  // for the rest of the process
    JPH::RegisterTypes();
    return true;
  }
};

}  // namespace broadmark
