// Runs a plan without the inspector.
#pragma once

#include "run/plan.h"

namespace broadmark {

/// Opens or simulates the plan's recordings, then runs, checks, measures and reports every case.
/// Shows progress unless `quiet`. Returns the exit status. Throws InputError.
int runHeadless(Plan plan, bool quiet);

}  // namespace broadmark
