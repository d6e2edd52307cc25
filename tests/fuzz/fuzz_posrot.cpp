// Any bytes as a .posrot recording.

#include "broadmark/recordings/posrot.h"
#include "read_through.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadmark::fuzz::readThrough<broadmark::PosrotReader>(data, size);
  return 0;
}
