// Any bytes as a compressed file: their start, and all of their lines.

#include "import_through.h"
#include "support/contents.h"
#include "support/line_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  fuzz::withFile(data, size, [](const std::filesystem::path& path) {
    const imports::FileStart start = imports::startOf(path);
    imports::LineReader lines(path);
    std::uint64_t bytes = 0;
    while (lines.next()) bytes += lines.line().size();
    // The start has no other bytes than the lines, besides line ends.
    if (start.whole && bytes > start.text.size()) std::abort();
  });
  return 0;
}
