// Adds the physics engine of the plug-in linked into this test program to the built-in engines.

#include "broadmark/scenes/engine_plugin.h"

extern "C" const broadmark::Plugin<broadmark::scenes::EngineEntry> broadmark_engine_plugin;

namespace {

[[maybe_unused]] const bool added = [] {
  for (const broadmark::scenes::EngineEntry& engine : broadmark_engine_plugin.entries()) {
    broadmark::scenes::addEngine(engine);
  }
  return true;
}();

}  // namespace
