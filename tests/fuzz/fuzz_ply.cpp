// Any bytes as a PLY file.

#include "mesh_through.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadmark::fuzz::meshThrough(broadmark::imports::readPly, data, size);
  return 0;
}
