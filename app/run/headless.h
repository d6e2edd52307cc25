// Running a plan without the inspector.
#pragma once

#include "command_line/session_options.h"
#include "run/plan.h"

namespace broadmark {

/// Opens or simulates the plan's recordings, runs every case on them, checks, measures and reports.
/// Returns the exit status. Throws InputError.
int runHeadless(Plan plan, const SessionOptions& options);

}  // namespace broadmark
