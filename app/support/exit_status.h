// Exit statuses, the same for all commands.
#pragma once

#include <algorithm>
#include <span>

#include "broadmark/harness/status.h"
#include "broadmark/names.h"

namespace broadmark {

/// Status that main() returns. If several apply, the first of: interrupted, wrong_answer,
/// bad_input, regression, timeout.
namespace exit_status {
enum Value : int {
  success = 0,
  wrong_answer = 1,
  bad_input = 2,  ///< any exception except Interrupted
  regression = 3,
  timeout = 4,
  interrupted = 130,  ///< 128 + SIGINT, as in shells
};
}  // namespace exit_status

/// Meaning of each status, for help and manual.
inline constexpr NameTable kExitStatuses{
    {NamedValue{exit_status::success, "success"},
     {exit_status::wrong_answer, "a wrong answer, or an algorithm that failed"},
     {exit_status::bad_input, "bad usage or bad input"},
     {exit_status::regression, "a regression (compare, duel)"},
     {exit_status::timeout, "a case exceeded a time limit"},
     {exit_status::interrupted, "interrupted (Ctrl-C)"}}};

/// Exit status of a command that ran cases with these statuses. A case that cannot run on this
/// machine is not a failure.
inline int exitStatusOf(std::span<const Status> statuses) {
  const auto any = [&](Status status) {
    return std::ranges::find(statuses, status) != statuses.end();
  };
  if (any(Status::mismatch) || any(Status::error)) return exit_status::wrong_answer;
  return any(Status::timeout) ? exit_status::timeout : exit_status::success;
}

}  // namespace broadmark
