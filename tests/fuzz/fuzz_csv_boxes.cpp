// Any bytes as boxes in CSV.

#include "import_through.h"

namespace broadmark::sources::csv_boxes {
SourceKind kind();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const broadmark::SourceKind kind = broadmark::sources::csv_boxes::kind();
  broadmark::fuzz::importThrough(kind, data, size);
  return 0;
}
