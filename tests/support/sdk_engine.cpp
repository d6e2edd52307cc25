// Adds the physics engine of the plug-in that this test program is linked with to all others.

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
