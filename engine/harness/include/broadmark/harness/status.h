// How a case ended.
//
// Example:
//
//   const std::string_view name = statusName(Status::timeout);    // "timeout"
//   const std::optional<Status> status = kStatuses.find("oops");  // nullopt
#pragma once

#include "broadmark/names.h"

namespace broadmark {

/// The end of a case; CaseResult::reason states the cause.
enum class Status {
  ok,           ///< within the limits, and without a mismatch if checked
  mismatch,     ///< a wrong answer; does not end the pass
  timeout,      ///< slower than a limit
  unsupported,  ///< cannot run here: instruction set, device, kind of answer or world, size
  error         ///< an exception of the algorithm, or the end of its process
};
/// The names in results and tables.
inline constexpr NameTable kStatuses{{NamedValue{Status::ok, "ok"},
                                      {Status::mismatch, "mismatch"},
                                      {Status::timeout, "timeout"},
                                      {Status::unsupported, "unsupported"},
                                      {Status::error, "error"}}};
/// A string literal: "ok".
constexpr std::string_view statusName(Status status) { return kStatuses.nameOf(status); }

}  // namespace broadmark
