// Algorithms in plug-ins: the symbols that a shared library exports so that `broadmark --plugin
// FILE` can load it. A line at the end makes a plug-in of a family's source file:
//
//   BROADMARK_PLUGIN(broadmark::my_sweep::variants)
//
// Build it with CMake:
//
//   find_package(broadmark REQUIRED)
//   broadmark_add_plugin(my_sweep my_sweep.cpp)
//
// The loading program provides all of the framework's code. For physics engines see
// broadmark/scenes/engine_plugin.h; a library may export both.
#pragma once

#include <vector>

#include "broadmark/algorithm.h"
#include "broadmark/compiler.h"
#include "broadmark/headers_hash.h"

// How this build's standard library lays out its types, if not as usual.
#if defined(_GLIBCXX_DEBUG)
#define BROADMARK_LIBRARY_LAYOUT ", checked containers"
#elif defined(_GLIBCXX_USE_CXX11_ABI) && !_GLIBCXX_USE_CXX11_ABI
#define BROADMARK_LIBRARY_LAYOUT ", old strings"
#else
#define BROADMARK_LIBRARY_LAYOUT ""
#endif

// How a library was built, according to its preprocessor and broadmark_add_plugin().
#if defined(__OPTIMIZE__)
#define BROADMARK_OPTIMISED true
#define BROADMARK_BUILD_OPTIMISED ", optimised"
#else
#define BROADMARK_OPTIMISED false
#define BROADMARK_BUILD_OPTIMISED ", not optimised"
#endif
#if defined(NDEBUG)
#define BROADMARK_BUILD_ASSERTS ""
#else
#define BROADMARK_BUILD_ASSERTS ", with assertions"
#endif
#if defined(__AVX512F__)
#define BROADMARK_BUILD_ISA ", AVX-512"
#elif defined(__AVX2__)
#define BROADMARK_BUILD_ISA ", AVX2"
#else
#define BROADMARK_BUILD_ISA ""
#endif
#if defined(__FAST_MATH__)
#define BROADMARK_BUILD_MATH ", fast math"
#else
#define BROADMARK_BUILD_MATH ""
#endif
#if defined(BROADMARK_BUILD_FLAGS)
#define BROADMARK_BUILD_OPTIONS ": " BROADMARK_BUILD_FLAGS
#else
#define BROADMARK_BUILD_OPTIONS ""
#endif
#define BROADMARK_BUILD                                                                    \
  BROADMARK_COMPILER BROADMARK_BUILD_OPTIMISED BROADMARK_BUILD_ASSERTS BROADMARK_BUILD_ISA \
      BROADMARK_BUILD_MATH BROADMARK_BUILD_OPTIONS

namespace broadmark {

/// The ABI that program and library must share to exchange C++ objects: the public headers, to the
/// byte, and the standard library's type layouts. Not inline: the loader would resolve a library's
/// copy to the program's.
constexpr char kPluginInterface[] =
    BROADMARK_VERSION_TEXT ", headers " BROADMARK_HEADERS_HASH BROADMARK_LIBRARY_LAYOUT;

/// The export of a library: entries of one type. The program never unloads the library.
template <class Entry>
struct Plugin {
  /// kPluginInterface of its build. Read before compatibility is checked; must stay the first
  /// member.
  const char* interface;
  /// Called by the program only if the interfaces are equal.
  std::vector<Entry> (*entries)();
  const char* build = nullptr;  ///< how it was built, in words; null: unknown
  bool optimised = true;        ///< false: the program warns
};

/// The symbol of an exported Plugin<Algorithm>.
inline constexpr char kAlgorithmPluginSymbol[] = "broadmark_plugin";

}  // namespace broadmark

// NOLINTBEGIN(bugprone-macro-parentheses): a name and a type
/// Exports a Plugin<Entry> under a symbol; entries() returns a std::vector of entries. At namespace
/// scope, once per library and symbol.
#define BROADMARK_EXPORT_PLUGIN(symbol, Entry, entries)                              \
  extern "C" {                                                                       \
  [[gnu::visibility("default")]] extern const ::broadmark::Plugin<Entry> symbol;     \
  const ::broadmark::Plugin<Entry> symbol = {::broadmark::kPluginInterface, entries, \
                                             BROADMARK_BUILD, BROADMARK_OPTIMISED};  \
  }                                                                                  \
  static_assert(true)
// NOLINTEND(bugprone-macro-parentheses)

/// Exports the algorithms that a function `std::vector<broadmark::Algorithm> variants()` returns.
/// At namespace scope, once per library.
#define BROADMARK_PLUGIN(variants) \
  BROADMARK_EXPORT_PLUGIN(broadmark_plugin, ::broadmark::Algorithm, variants)
