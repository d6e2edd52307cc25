// Runs the inspector, for the main command.
#pragma once

#include "request/inspector_options.h"

namespace broadmark {

struct Plan;

/// Opens the plan's source in a window or off-screen. Returns the exit status. Throws InputError.
int runInspector(Plan plan, bool in_window, const InspectorOptions& options);

}  // namespace broadmark
