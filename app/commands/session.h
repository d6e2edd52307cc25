// The main command.
#pragma once

#include "command_line/session_options.h"

namespace broadmark {

/// Makes the plan, then lists it, runs it, exports its case or opens it in the inspector. Returns
/// the exit status. Throws InputError.
int runSession(const SessionOptions&);

}  // namespace broadmark
