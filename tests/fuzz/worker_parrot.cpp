// A worker process that says what it was told to: worker_parrot FILE. The file's lines are its
// messages, the first at once, one more for each call; what stands behind a zero byte is the memory
// that it shares. Then it ends.

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <string_view>

int main(int argc, char** argv) {
  constexpr int kChannel = 3;  // as engine/worker/protocol.h has it
  constexpr int kAnswers = 5;
  if (argc != 2) return 2;
  std::string text;
  char part[4096];
  const int file = ::open(argv[1], O_RDONLY);
  for (ssize_t got = 0; (got = ::read(file, part, sizeof(part))) > 0;) {
    text.append(part, static_cast<std::size_t>(got));
  }
  const std::string_view all(text);
  const std::size_t end = std::min(all.find('\0'), all.size());
  const std::string_view memory = all.substr(std::min(end + 1, all.size()));
  if (::pwrite(kAnswers, memory.data(), memory.size(), 0) < 0) return 2;
  for (std::string_view lines = all.substr(0, end); !lines.empty();) {
    const std::size_t line = std::min(lines.find('\n'), lines.size());
    if (::send(kChannel, lines.data(), line, MSG_NOSIGNAL) < 0) return 0;
    lines.remove_prefix(std::min(line + 1, lines.size()));
    if (::recv(kChannel, part, 1, 0) <= 0) return 0;
  }
  return 0;
}
