// Any text is either a script of the inspector, or an InputError in one line.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "broadmark/error.h"
#include "inspector/script.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  try {
    int before = 0;
    for (const ScriptLine& line :
         parseScript({reinterpret_cast<const char*>(data), size}, "fuzz")) {
      if (line.number <= before || line.verb == nullptr) std::abort();
      if (line.words.size() < line.verb->min_words || line.words.size() > line.verb->max_words) {
        std::abort();
      }
      before = line.number;
    }
  } catch (const InputError& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
