// The inspector as the main command runs it.
#pragma once

namespace broadmark {

struct Plan;
struct SessionOptions;

/// Opens the plan's source in a window or, with --ui, off-screen. Returns the exit status. Throws
/// InputError.
int runInspector(Plan plan, const SessionOptions& options);

}  // namespace broadmark
