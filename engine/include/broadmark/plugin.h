// Algorithms from outside: what a shared library exports so that `broadmark --plugin FILE` can load
// it. A family's source file becomes one by a line at its end:
//
//   BROADMARK_PLUGIN(broadmark::my_sweep::variants)
//
// and by CMake's
//
//   add_library(my_sweep MODULE my_sweep.cpp)
//   target_link_libraries(my_sweep PRIVATE broadmark::broadmark)
//
// It takes all of the framework's code from the program that loads it.
#pragma once

#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/headers_hash.h"

#if defined(_GLIBCXX_DEBUG)
#define BROADMARK_LIBRARY_LAYOUT ", checked containers"
#elif defined(_GLIBCXX_USE_CXX11_ABI) && !_GLIBCXX_USE_CXX11_ABI
#define BROADMARK_LIBRARY_LAYOUT ", old strings"
#else
#define BROADMARK_LIBRARY_LAYOUT ""
#endif

namespace broadmark {

/// What program and library must have in common, for they exchange C++ objects: the public headers,
/// to the byte, and how the standard library lays out its types.
inline constexpr char kPluginInterface[] =
    BROADMARK_VERSION_TEXT ", headers " BROADMARK_HEADERS_HASH BROADMARK_LIBRARY_LAYOUT;

/// What a library exports under kPluginSymbol.
struct Plugin {
  /// kPluginInterface of its build. Read before compatibility is known; must stay the first member.
  const char* interface;
  std::vector<Algorithm> (*variants)();
};

inline constexpr char kPluginSymbol[] = "broadmark_plugin";

}  // namespace broadmark

/// Exports the algorithms that a function `std::vector<broadmark::Algorithm> variants()` returns.
#define BROADMARK_PLUGIN(variants)                                                        \
  extern "C" {                                                                            \
  [[gnu::visibility("default")]] extern const ::broadmark::Plugin broadmark_plugin;       \
  const ::broadmark::Plugin broadmark_plugin = {::broadmark::kPluginInterface, variants}; \
  }                                                                                       \
  static_assert(true)
