// Any file is either a log of pairs in which each pair is ordered, or an InputError.

#include <fmt/format.h>

#include "broadmark/error.h"
#include "fuzzed_file.h"
#include "request/pair_log.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  const FileDescriptor file = fuzz::fuzzedFile(data, size);
  try {
    PairLog log(fmt::format("/proc/self/fd/{}", file.get()));
    constexpr std::uint32_t kMaxFrames = 100;
    for (std::uint32_t frame = 0; frame <= std::min(log.lastFrame(), kMaxFrames); ++frame) {
      for (const Pair pair : log.pairsOf(frame)) {
        if (pair.a > pair.b) std::abort();
      }
    }
  } catch (const InputError&) {
    return 0;
  }
  return 0;
}
