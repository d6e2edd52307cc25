// A plug-in from another build: its headers were not the program's.

#include "broadmark/plugin.h"

namespace {

std::vector<broadmark::Algorithm> variants() { return {}; }

}  // namespace

extern "C" [[gnu::visibility("default")]] const broadmark::Plugin broadmark_plugin;
extern "C" const broadmark::Plugin broadmark_plugin = {"9.9.9, headers of old", variants};
