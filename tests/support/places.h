// Where things lie that tests need, whatever folder they run in.
#pragma once

#include <filesystem>
#include <string>

namespace broadmark::places {

/// A file of the source tree, by its path there.
std::filesystem::path source(const std::string& path);
/// The real program.
std::string program();
/// A plug-in with algorithms that are wrong on purpose.
std::string faultyPlugin();
/// A plug-in with an algorithm that crashes, hangs or fails otherwise when asked to.
std::string unrulyPlugin();
/// A plug-in with a physics engine, `drift`.
std::string enginePlugin();
/// A plug-in that belongs to another version.
std::string foreignPlugin();
/// A library that makes system calls under the program fail; "" in builds with sanitizers.
std::string faultInjection();

}  // namespace broadmark::places
