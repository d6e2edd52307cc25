// How a case ended.
#pragma once

#include "broadmark/names.h"

namespace broadmark {

enum class Status {
  ok,
  mismatch,     ///< a wrong answer
  timeout,      ///< slower than the limit
  unsupported,  ///< cannot run here: no such instruction set, device or size
  error
};
inline constexpr NameTable kStatuses{{NamedValue{Status::ok, "ok"},
                                      {Status::mismatch, "mismatch"},
                                      {Status::timeout, "timeout"},
                                      {Status::unsupported, "unsupported"},
                                      {Status::error, "error"}}};
constexpr std::string_view statusName(Status status) { return kStatuses.nameOf(status); }

}  // namespace broadmark
