// Any bytes as an OBJ file.

#include "mesh_through.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadmark::fuzz::meshThrough(broadmark::imports::readObj, data, size);
  return 0;
}
