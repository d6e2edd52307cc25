// Any messages as calls to a worker, a line each, and behind a zero byte any bytes as the memory
// that both sides share: each call is answered, with an error or without, and the worker stays.

#include <sys/socket.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>

#include "broadmark/algorithms.h"
#include "broadmark/error.h"
#include "worker/protocol.h"

namespace broadmark {
namespace {

/// A message that neither starts thousands of threads nor takes the fuzzer its memory.
std::string harmless(std::string_view line) {
  Json message = jsonOrNull(line);
  if (!message.is_object()) return std::string(line);
  if (message.contains("memory_limit_bytes")) message["memory_limit_bytes"] = 0;
  if (message.contains("threads") && message["threads"] > 3) message["threads"] = 3;
  if (message.contains("pin")) message["pin"] = false;
  return formatJson(message, -1);
}

/// An algorithm that reads nothing but boxes; how others treat invalid frames is not tested here.
Algorithm bruteForce(const std::string& id, const std::string& /*plugin*/) {
  for (Algorithm& algorithm : builtinAlgorithms()) {
    if (algorithm.id == "bf") return algorithm;
  }
  throw InputError(id);
}

void sendLines(int socket, std::string_view lines) {
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string message = harmless(lines.substr(0, end));
    if (!message.empty()) ::send(socket, message.data(), message.size(), MSG_NOSIGNAL);
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  ::shutdown(socket, SHUT_WR);
}

}  // namespace
}  // namespace broadmark

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(text.find('\0'), text.size());
  SharedMemory frames;
  frames.write(std::as_bytes(std::span(text).subspan(end)));
  worker::ChannelEnds ends = worker::openChannel();
  std::jthread host([&] {
    sendLines(ends.here.get(), text.substr(0, end));
    char answer = 0;
    while (::recv(ends.here.get(), &answer, 1, 0) > 0) {
    }
  });
  worker::Channel channel(std::move(ends.there));
  try {
    worker::answerCalls(channel, std::move(frames), SharedMemory(), bruteForce);
  } catch (const HostError&) {
  }
  channel = worker::Channel(FileDescriptor());  // hangs up
  return 0;
}
