// A plug-in built with other headers than the program.

#include "broadmark/headers_hash.h"

#undef BROADMARK_VERSION_TEXT
#define BROADMARK_VERSION_TEXT "9.9.9"
#include "broadmark/plugin.h"

namespace {

std::vector<broadmark::Algorithm> variants() { return {}; }

}  // namespace

BROADMARK_PLUGIN(variants);
