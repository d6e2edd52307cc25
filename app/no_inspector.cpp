// Replaces the folder inspector/ in builds without the inspector.

#include "broadmark/error.h"
#include "inspector/run_inspector.h"
#include "run/plan.h"
#include "support/build_parts.h"

namespace broadmark {

int runInspector(Plan /*plan*/, bool in_window, const InspectorOptions& /*options*/) {
  throw InputError(in_window ? leftOut(parts::kInspector) + ": add --headless"
                             : "--ui: " + leftOut(parts::kInspector));
}

}  // namespace broadmark
