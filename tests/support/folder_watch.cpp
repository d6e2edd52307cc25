#include "support/folder_watch.h"

#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace broadmark::tests {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kChanges =
    IN_CREATE | IN_MODIFY | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_CLOSE_WRITE;

}  // namespace

FolderWatch::FolderWatch(fs::path folder)
    : folder_(std::move(folder)), events_(::inotify_init1(IN_CLOEXEC)) {
  if (events_.get() < 0) throw std::runtime_error("no inotify");
}

void FolderWatch::add(int file) const {
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  ::inotify_add_watch(events_.get(), path.c_str(), IN_MODIFY);
}

bool FolderWatch::waitUntil(const std::function<bool()>& condition, int process) const {
  for (bool has_ended = false;;) {
    // Watches are added before the condition is tested, so that no change is missed.
    addFolders();
    if (condition()) return true;
    if (has_ended) return false;
    std::array<pollfd, 2> awaited{{{events_.get(), POLLIN, 0}, {process, POLLIN, 0}}};
    ::poll(awaited.data(), awaited.size(), -1);
    has_ended = awaited[1].revents != 0;
    std::array<char, 1 << 16> events;
    if (awaited[0].revents != 0 && ::read(events_.get(), events.data(), events.size()) < 0) {
      throw std::runtime_error("inotify cannot be read");
    }
  }
}

void FolderWatch::addFolders() const {
  const auto add = [this](const fs::path& folder) {
    ::inotify_add_watch(events_.get(), folder.c_str(), kChanges);
  };
  add(folder_);
  std::error_code gone;  // a folder may vanish meanwhile
  for (fs::recursive_directory_iterator at(folder_, gone); at != end(at); at.increment(gone)) {
    if (at->is_directory(gone)) add(at->path());
  }
}

}  // namespace broadmark::tests
