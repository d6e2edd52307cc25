// Part of builds with sanitizers only. Libraries that have been loaded stay until the end: a leak
// in one that has gone could no longer be told by its name, as tests/leaks.supp does.

#include <dlfcn.h>

extern "C" int dlclose(void* /*library*/) noexcept { return 0; }
