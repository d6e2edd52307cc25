// Any bytes are either a .posrot recording that can be read to its end, or an InputError.

#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <span>

#include "broadmark/error.h"
#include "broadmark/posrot.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark;
  FileDescriptor file(::memfd_create("fuzz", 0));
  writeAll(file.get(), std::as_bytes(std::span(data, size)), "fuzz");
  try {
    PosrotReader recording(std::move(file), "fuzz");
    Frame frame = recording.rewind();
    // Frames of no bodies take no bytes, so their number is no measure of work.
    for (int i = 0; i < 1000; ++i) {
      for (const Aabb& box : frame.boxes) {
        if (!overlaps(box, box)) std::abort();
      }
      const auto next = recording.next();
      if (!next) break;
      frame = *next;
    }
    if (recording.hash().size() != 32) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
