// Any bytes as a LAMMPS dump.

#include "import_through.h"

namespace broadmark::sources::lammps {
SourceKind kind();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const broadmark::SourceKind kind = broadmark::sources::lammps::kind();
  broadmark::fuzz::particlesThrough(kind, data, size);
  return 0;
}
