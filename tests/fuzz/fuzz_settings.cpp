// Any text is either a settings file of the original Broadmark, or an InputError.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "broadmark/error.h"
#include "broadmark/original_settings.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    if (jsonKind(text, "fuzz") != "original-settings") return 0;
    const OriginalSettings settings = parseOriginalSettings(text, "fuzz");
    if (formatOriginalLog(settings, CaseResult{}).empty()) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
