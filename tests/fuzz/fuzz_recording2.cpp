// Any bytes as a .broadmark recording.

#include "broadmark/recordings/recording2.h"
#include "read_through.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadmark::fuzz::readThrough<broadmark::Recording2Reader>(data, size);
  return 0;
}
