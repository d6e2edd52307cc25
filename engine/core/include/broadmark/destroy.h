// Ownership of objects made by a C library.
#pragma once

namespace broadmark {

/// A deleter for std::unique_ptr: calls the library's function that destroys or releases an object.
template <auto destroy>
struct Destroy {
  template <class Object>
  void operator()(Object* object) const {
    destroy(object);
  }
};

}  // namespace broadmark
