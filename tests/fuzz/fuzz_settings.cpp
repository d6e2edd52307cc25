// Any text is either a settings file of the original Broadmark, or an InputError.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "broadmark/error.h"
#include "original/settings.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::string log;
  try {
    if (!isOriginalSettings(text, "fuzz")) return 0;
    log = formatOriginalLog(parseOriginalSettings(text, "fuzz"), CaseResult{});
  } catch (const InputError&) {
    return 0;
  }
  // The log must be JSON, and not a settings file itself: an InputError ends the program.
  if (isOriginalSettings(log, "log")) std::abort();
  return 0;
}
