// Running a plan without the inspector.
#pragma once

#include "plan.h"
#include "session_options.h"

namespace broadmark {

/// Opens or simulates the plan's recordings, runs every case on them, checks, measures and reports.
/// Returns the exit status. Throws InputError.
int runHeadless(Plan plan, const SessionOptions& options);

}  // namespace broadmark
