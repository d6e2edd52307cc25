// Running a plan without the inspector.
#pragma once

#include "run/plan.h"

namespace broadmark {

/// Opens or simulates the plan's recordings, runs every case on them, checks, measures and reports;
/// no progress when `quiet`. Returns the exit status. Throws InputError.
int runHeadless(Plan plan, bool quiet);

}  // namespace broadmark
