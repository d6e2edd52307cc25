// Ownership of a C library's objects.
#pragma once

namespace broadmark {

/// A deleter for std::unique_ptr that calls a C library's function to destroy or release an object.
template <auto destroy>
struct CDeleter {
  template <class Object>
  void operator()(Object* object) const {
    destroy(object);
  }
};

}  // namespace broadmark
