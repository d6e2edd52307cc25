// Threads that the system may refuse: browsers grant none to a page that is not isolated.
#pragma once

#include <system_error>
#include <thread>
#include <utility>

namespace broadmark {

/// Starts `work` in a thread, which is not joinable if the system grants none: then the caller
/// works itself.
template <class Work>
std::thread grantedThread(Work work) {
  try {
    return std::thread(std::move(work));
  } catch (const std::system_error&) {
    return {};
  }
}

}  // namespace broadmark
