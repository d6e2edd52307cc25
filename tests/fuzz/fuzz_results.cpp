// Any text is either results that survive a round trip unchanged, or an InputError.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "broadmark/error.h"
#include "broadmark/results/results.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  Results results;
  try {
    results = parseResults({reinterpret_cast<const char*>(data), size}, "fuzz");
  } catch (const InputError&) {
    return 0;
  }
  std::string first;
  for (const ResultWriter& writer : resultWriters()) {
    const std::string text = writer.format(results);
    if (writer.name == "json") first = text;
  }
  // What the program writes it must read: an InputError here ends the program.
  if (resultWriters().front().format(parseResults(first, "fuzz")) != first) std::abort();
  return 0;
}
