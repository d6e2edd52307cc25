// The inspector as the main command runs it.
#pragma once

#include <filesystem>

namespace broadmark {

struct Plan;

/// Opens the plan's source in a window, or off-screen. Plays the script, if there is one ("").
/// Returns the exit status. Throws InputError.
int runInspector(Plan plan, bool in_window, const std::filesystem::path& script);

}  // namespace broadmark
