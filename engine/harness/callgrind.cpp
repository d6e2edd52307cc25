#include "callgrind.h"

#include <unistd.h>

#include <array>
#include <charconv>
#include <cstddef>
#include <span>
#include <string_view>

#include "broadmark/files.h"

namespace broadmark::callgrind {
namespace {

/// Client requests of valgrind and callgrind.
enum class Request : std::uintptr_t {
  running_on_valgrind = 0x1001,
  dump = std::uintptr_t{'C'} << 24 | std::uintptr_t{'T'} << 16,
  start_instrumentation = dump + 4,
  stop_instrumentation = dump + 5
};

/// Sends a request to valgrind. Returns its answer, or 0 without valgrind.
std::uintptr_t request(Request which) {
  const volatile std::array<std::uintptr_t, 6> message = {static_cast<std::uintptr_t>(which)};
  std::uintptr_t answer = 0;
#if defined(__x86_64__)
  asm volatile(
      "rolq $3, %%rdi; rolq $13, %%rdi; rolq $61, %%rdi; rolq $51, %%rdi\n\t"
      "xchgq %%rbx, %%rbx"
      : "+d"(answer)
      : "a"(&message)
      : "cc", "memory");
#elif defined(__aarch64__)
  asm volatile(
      "mov x3, %0\n\t"
      "mov x4, %1\n\t"
      "ror x12, x12, #3; ror x12, x12, #13; ror x12, x12, #51; ror x12, x12, #61\n\t"
      "orr x10, x10, x10\n\t"
      "mov %0, x3"
      : "+r"(answer)
      : "r"(&message)
      : "cc", "memory", "x3", "x4");
#else
  static_cast<void>(message);
#endif
  return answer;
}

}  // namespace

std::vector<std::string> commandUnder(const std::vector<std::string>& command) {
  std::vector<std::string> words = {
      "valgrind",
      "--tool=callgrind",
      "--quiet",
      "--vgdb=no",
      "--instr-atstart=no",
      "--combine-dumps=yes",
      "--callgrind-out-file=/proc/self/fd/" + std::to_string(kCountsDescriptor)};
  words.insert(words.end(), command.begin(), command.end());
  return words;
}

bool isRunning() { return request(Request::running_on_valgrind) != 0; }
void start() { request(Request::start_instrumentation); }
void stop() { request(Request::stop_instrumentation); }

std::optional<std::uint64_t> takeInstructions() {
  if (::ftruncate(kCountsDescriptor, 0) != 0) return std::nullopt;
  request(Request::dump);
  const off_t size = ::lseek(kCountsDescriptor, 0, SEEK_END);
  if (size <= 0) return std::nullopt;
  std::string text(static_cast<std::size_t>(size), '\0');
  if (readAll(kCountsDescriptor, std::as_writable_bytes(std::span(text)), 0) < text.size()) {
    return std::nullopt;
  }
  constexpr std::string_view kTotals = "\ntotals: ";
  const auto begin = text.rfind(kTotals);
  if (begin == text.npos) return std::nullopt;
  std::uint64_t count = 0;
  const char* const number = text.data() + begin + kTotals.size();
  const auto [end, error] = std::from_chars(number, text.data() + text.size(), count);
  return error == std::errc() ? std::optional(count) : std::nullopt;
}

}  // namespace broadmark::callgrind
