// Physics engines in plug-ins: the symbols that a shared library exports so that `broadmark
// --plugin FILE` can load it, as broadmark/plugin.h describes for algorithms. A line at the end
// makes a plug-in of an engine's source file:
//
//   BROADMARK_ENGINE_PLUGIN(broadmark::my_engine::engines)
//
// Example:
//
//   using Create = std::unique_ptr<scenes::PhysicsEngine> (*)(const scenes::PhysicsSettings&);
//   const auto engines = [](Create create) {  // a plug-in has a function without arguments
//     return std::vector<scenes::EngineEntry>{
//         {{.id = "my_engine", .summary = "bodies fall", .plugin = ""}, create}};
//   };
#pragma once

#include "broadmark/plugin.h"
#include "broadmark/scenes/registry.h"

namespace broadmark::scenes {

/// The symbol of an exported Plugin<EngineEntry>, for dlsym().
inline constexpr char kEnginePluginSymbol[] = "broadmark_engine_plugin";

}  // namespace broadmark::scenes

/// Exports the engines that a function `std::vector<broadmark::scenes::EngineEntry> engines()`
/// returns: once per library, outside of any namespace. The loader sets EngineListing::plugin. In a
/// simulation, exceptions of the engine become InputErrors that name it.
#define BROADMARK_ENGINE_PLUGIN(engines) \
  BROADMARK_EXPORT_PLUGIN(broadmark_engine_plugin, ::broadmark::scenes::EngineEntry, engines)
