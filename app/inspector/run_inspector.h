// Runs the inspector, for the main command.
#pragma once

#include <filesystem>

namespace broadmark {

struct Plan;

/// Opens the plan's source in a window or off-screen, and plays the script ("": none). Returns the
/// exit status. Throws InputError.
int runInspector(Plan plan, bool in_window, const std::filesystem::path& script);

}  // namespace broadmark
