#include "support/exit_status.h"

#include <algorithm>

namespace broadmark {

int exitStatusOf(std::span<const Status> statuses) {
  const auto any = [&](Status status) {
    return std::ranges::find(statuses, status) != statuses.end();
  };
  if (any(Status::mismatch) || any(Status::error)) return exit_status::wrong_answer;
  return any(Status::timeout) ? exit_status::timeout : exit_status::fine;
}

}  // namespace broadmark
