// Any bytes as a LAMMPS dump.

#include "import_through.h"

namespace broadmark::sources::lammps {
SourceKind kind();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const broadmark::SourceKind kind = broadmark::sources::lammps::kind();
  // With a radius of its own, or one that is said.
  broadmark::fuzz::importThrough(kind, data, size, static_cast<double>(size % 2));
  return 0;
}
