// A plug-in from another build: its headers were not the program's.

#include "broadmark/headers_hash.h"

#undef BROADMARK_VERSION_TEXT
#define BROADMARK_VERSION_TEXT "9.9.9"
#include "broadmark/plugin.h"

namespace {

std::vector<broadmark::Algorithm> variants() { return {}; }

}  // namespace

BROADMARK_PLUGIN(variants);
