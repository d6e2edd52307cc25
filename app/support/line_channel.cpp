#include "support/line_channel.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>

namespace broadmark {

std::optional<std::string> LineChannel::read(const CancelQuery& cancelled) {
  constexpr int kPollMilliseconds = 50;
  constexpr std::size_t kMaxLength = std::size_t{1} << 20;
  while (true) {
    if (const std::size_t end = unread_.find('\n'); end != std::string::npos) {
      std::string line = unread_.substr(0, end);
      unread_.erase(0, end + 1);
      return line;
    }
    if (unread_.size() > kMaxLength) throw std::runtime_error("a line is longer than a mebibyte");
    if (cancelled && cancelled()) throw Cancelled();
    pollfd waiting{.fd = from_.get(), .events = POLLIN, .revents = 0};
    if (::poll(&waiting, 1, kPollMilliseconds) <= 0) continue;
    std::array<char, 4096> bytes{};
    const ssize_t count = ::read(from_.get(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::nullopt;
    unread_.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace broadmark
