// Any bytes as an array of boxes.

#include "import_through.h"

namespace broadmark::sources::numpy_boxes {
SourceKind kind();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const broadmark::SourceKind kind = broadmark::sources::numpy_boxes::kind();
  broadmark::fuzz::importThrough(kind, data, size);
  return 0;
}
