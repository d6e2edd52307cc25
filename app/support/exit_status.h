// How the program ends, the same in all commands.
#pragma once

#include <algorithm>
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
    {NamedValue{exit_status::fine, "success"},
     {exit_status::wrong_answer, "a wrong answer, or an algorithm that failed"},
     {exit_status::bad_input, "bad usage or bad input"},
     {exit_status::regression, "a regression (compare)"},
     {exit_status::timeout, "a case crossed a time limit"},
     {exit_status::interrupted, "interrupted (Ctrl-C)"}}};

/// Exit status of a command with these statuses of cases. A case that cannot run here is no
/// failure.
inline int exitStatusOf(std::span<const Status> statuses) {
  const auto any = [&](Status status) {
    return std::ranges::find(statuses, status) != statuses.end();
  };
  if (any(Status::mismatch) || any(Status::error)) return exit_status::wrong_answer;
  return any(Status::timeout) ? exit_status::timeout : exit_status::fine;
}

}  // namespace broadmark
