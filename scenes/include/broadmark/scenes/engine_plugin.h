// Physics engines from outside: what a shared library exports so that `broadmark --plugin FILE` can
// load it, as broadmark/plugin.h says it of algorithms. An engine's source file becomes one by a
// line at its end:
//
//   BROADMARK_ENGINE_PLUGIN(broadmark::my_engine::engines)
#pragma once

#include "broadmark/plugin.h"
#include "broadmark/scenes/registry.h"

namespace broadmark::scenes {

/// Under this name a library exports a Plugin<EngineEntry>.
inline constexpr char kEnginePluginSymbol[] = "broadmark_engine_plugin";

}  // namespace broadmark::scenes

/// Exports the engines that a function `std::vector<broadmark::scenes::EngineEntry> engines()`
/// returns.
#define BROADMARK_ENGINE_PLUGIN(engines) \
  BROADMARK_EXPORT_PLUGIN(broadmark_engine_plugin, ::broadmark::scenes::EngineEntry, engines)
