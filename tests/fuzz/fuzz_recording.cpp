// Any bytes as an .aabbs recording.

#include "read_through.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadmark::fuzz::readThrough<broadmark::RecordingReader>(data, size);
  return 0;
}
