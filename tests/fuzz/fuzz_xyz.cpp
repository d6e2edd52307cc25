// Any bytes as an XYZ file.

#include "import_through.h"

namespace broadmark::sources::xyz {
SourceKind kind();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const broadmark::SourceKind kind = broadmark::sources::xyz::kind();
  broadmark::fuzz::particlesThrough(kind, data, size);
  return 0;
}
