// Declares the entries of one list and defines the function that returns them all. Included by
// registry.cpp once for each list, with these macros defined: LIST, the file that CMake generates
// from the list; ENTRY_TYPE; ENTRIES, the function's name.

#define ENTRY(name)   \
  namespace name {    \
  ENTRY_TYPE entry(); \
  }
#include LIST
#undef ENTRY

std::vector<ENTRY_TYPE> ENTRIES() {
  return {
#define ENTRY(name) name::entry(),
#include LIST
#undef ENTRY
  };
}

#undef LIST
#undef ENTRY_TYPE
#undef ENTRIES
