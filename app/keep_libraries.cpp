// Only in builds with sanitizers: keeps libraries loaded until the program ends, so that a leak
// report can name the library, as tests/leaks.supp needs it.

#include <dlfcn.h>

extern "C" int dlclose(void* /*library*/) noexcept { return 0; }
