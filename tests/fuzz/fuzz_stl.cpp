// Any bytes as an STL file.

#include "mesh_through.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadmark::fuzz::meshThrough(broadmark::imports::readStl, data, size);
  return 0;
}
