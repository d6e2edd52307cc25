// Stands for the folder inspector/ in a build without it.

#include "broadmark/error.h"
#include "command_line/option_types.h"
#include "command_line/session_options.h"
#include "inspector/run_inspector.h"
#include "run/plan.h"

namespace broadmark {

int runInspector(Plan /*plan*/, const SessionOptions& options) {
  throw InputError(options.headless ? "--ui: " + leftOut(parts::kInspector)
                                    : leftOut(parts::kInspector) + ": add --headless");
}

}  // namespace broadmark
