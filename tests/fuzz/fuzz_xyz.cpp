// Any bytes as an XYZ file.

#include "import_through.h"

namespace broadmark::sources::xyz {
SourceKind kind();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const broadmark::SourceKind kind = broadmark::sources::xyz::kind();
  // With a radius of its own, or one that is said.
  broadmark::fuzz::importThrough(kind, data, size, static_cast<double>(size % 2));
  return 0;
}
