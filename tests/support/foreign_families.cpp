// The algorithms of shared libraries with the C interface, and of programs, in place of the
// built-in ones.

#include <dlfcn.h>

#include <cstring>
#include <stdexcept>

#include "request/c_plugin.h"
#include "request/external_program.h"
#include "request/plugins.h"

namespace broadmark {

static std::vector<Algorithm> load(const char* file) {
  if (!isLibrary(file)) return {externalAlgorithm(file + std::strlen(kExternalPrefix))};
  void* const library = ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw std::runtime_error(::dlerror());
  const auto table =
      reinterpret_cast<decltype(&broadmark_c_plugin)>(::dlsym(library, kCPluginSymbol));
  return algorithmsOf(table(), file);
}

#define FOREIGN_FAMILY(name, file)                         \
  namespace name {                                         \
  std::vector<Algorithm> variants() { return load(file); } \
  }
#include "foreign_files.inc"
#undef FOREIGN_FAMILY

}  // namespace broadmark
