// Stands for the folder inspector/ in a build without it.

#include "broadmark/error.h"
#include "inspector/run_inspector.h"
#include "option_types.h"
#include "plan.h"
#include "session_options.h"

namespace broadmark {

int runInspector(Plan /*plan*/, const SessionOptions& options) {
  throw InputError(options.headless ? "--ui: " + leftOut(parts::kInspector)
                                    : leftOut(parts::kInspector) + ": add --headless");
}

}  // namespace broadmark
