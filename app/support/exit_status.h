// How the program ends, the same in all commands.
#pragma once

#include <span>

#include "broadmark/harness/status.h"
#include "broadmark/names.h"

namespace broadmark {

/// What main() returns. Of several that apply it is the first of: interrupted, wrong_answer,
/// bad_input, regression, timeout.
namespace exit_status {
enum Value : int {
  fine = 0,
  wrong_answer = 1,
  bad_input = 2,  ///< whatever is thrown, but for Interrupted
  regression = 3,
  timeout = 4,
  interrupted = 130,  ///< as shells have it: 128 + SIGINT
};
}  // namespace exit_status

/// The meaning of each, for help and manual.
inline constexpr NameTable kExitStatuses{
    {NamedValue{exit_status::fine, "all well"},
     {exit_status::wrong_answer, "a wrong answer, or an algorithm that failed"},
     {exit_status::bad_input, "bad usage or bad input"},
     {exit_status::regression, "a regression (compare)"},
     {exit_status::timeout, "a case crossed a time limit"},
     {exit_status::interrupted, "interrupted (Ctrl-C)"}}};

/// How a command ends whose cases have these statuses. A case that cannot run here is no failure.
int exitStatusOf(std::span<const Status> statuses);

}  // namespace broadmark
