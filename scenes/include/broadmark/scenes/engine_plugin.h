// Physics engines in plug-ins: the symbols that a shared library exports so that `broadmark
// --plugin FILE` can load it, as broadmark/plugin.h describes for algorithms. A line at the end
// makes a plug-in of an engine's source file:
//
//   BROADMARK_ENGINE_PLUGIN(broadmark::my_engine::engines)
#pragma once

#include "broadmark/plugin.h"
#include "broadmark/scenes/registry.h"

namespace broadmark::scenes {

/// The symbol of an exported Plugin<EngineEntry>.
inline constexpr char kEnginePluginSymbol[] = "broadmark_engine_plugin";

}  // namespace broadmark::scenes

/// Exports the engines that a function `std::vector<broadmark::scenes::EngineEntry> engines()`
/// returns.
#define BROADMARK_ENGINE_PLUGIN(engines) \
  BROADMARK_EXPORT_PLUGIN(broadmark_engine_plugin, ::broadmark::scenes::EngineEntry, engines)
