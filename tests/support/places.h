// Paths of files that tests need, independent of the working directory.
#pragma once

#include <filesystem>
#include <string>

namespace broadmark::places {

/// A file of the source tree, by its relative path.
std::filesystem::path source(const std::string& path);
/// The real program.
std::string program();
/// A plug-in with algorithms that are wrong on purpose.
std::string faultyPlugin();
/// A plug-in with an algorithm that crashes, hangs or fails otherwise on request.
std::string unrulyPlugin();
/// A plug-in with a physics engine, `drift`.
std::string enginePlugin();
/// A plug-in with a physics engine, `unruly`, that crashes, hangs or throws on request.
std::string unrulyEngine();
/// A plug-in with an algorithm that is refused for the fault named by INVALID_PLUGIN.
std::string invalidPlugin();
/// Builds of a plug-in with the algorithm `repeated-search`: the second one is many times slower,
/// the third one finds nothing.
std::string quickPlugin();
std::string slowPlugin();
std::string idlePlugin();
/// A plug-in built for another version.
std::string foreignPlugin();
/// A library that makes system calls under the program fail; "" in builds with sanitizers.
std::string faultInjection();

}  // namespace broadmark::places
