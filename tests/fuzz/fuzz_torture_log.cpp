// Any text is either the log with which a torture goes on (torture.json), one that survives a round
// trip unchanged, or an InputError.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "broadmark/error.h"
#include "commands/torture_log.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  TortureLog log;
  try {
    log = parseTortureLog({reinterpret_cast<const char*>(data), size}, "fuzz");
  } catch (const InputError& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
    return 0;
  }
  if (formatTortureLog(log).empty()) std::abort();
  // What the program writes it must read: an InputError here ends the program.
  const std::string text = tortureLogText(log);
  if (tortureLogText(parseTortureLog(text, "written")) != text) std::abort();
  return 0;
}
