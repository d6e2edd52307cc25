// A library opened at run time.
#pragma once

#include <dlfcn.h>

#include <string>

#include "broadmark/render/picture.h"

namespace broadmark {

/// Stays loaded until the process ends: GL drivers start threads and register exit handlers, and
/// crash when unloaded.
class SharedLibrary {
 public:
  /// Throws RenderError.
  explicit SharedLibrary(const std::string& name)
      : name_(name), handle_(dlopen(name.c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE)) {
    if (handle_ == nullptr) throw RenderError(name + " not found");
  }

  /// Throws RenderError when the library has no such function.
  template <class Function>
  Function get(const char* function) const {
    void* address = dlsym(handle_, function);
    if (address == nullptr) throw RenderError(name_ + " lacks " + function);
    return reinterpret_cast<Function>(address);
  }

 private:
  std::string name_;
  void* handle_;
};

}  // namespace broadmark
