// What every parser of recordings promises: any bytes are either a recording that can be read to
// its end, or an InputError.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/recording.h"

namespace broadmark::fuzz {

/// Reads the bytes as the recording of a Reader, made from an open descriptor and a name.
template <class Reader>
void readThrough(const std::uint8_t* data, std::size_t size) {
  FileDescriptor file(::memfd_create("fuzz", 0));
  writeAll(file.get(), std::as_bytes(std::span(data, size)), "fuzz");
  try {
    Reader recording(std::move(file), "fuzz");
    Frame frame = recording.rewind();
    // Frames without bodies take no bytes: a short file may state any number of them.
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
}

}  // namespace broadmark::fuzz
