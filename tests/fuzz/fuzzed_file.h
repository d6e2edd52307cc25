// An input as a file.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "broadmark/files.h"

namespace broadmark::fuzz {

/// A file of these bytes, until the next one is asked for: they share one that is in memory only,
/// as to make a new one takes longer than most parsers do.
inline FileDescriptor fuzzedFile(const std::uint8_t* data, std::size_t size) {
  static const FileDescriptor file(::memfd_create("fuzz", 0));
  ::lseek(file.get(), 0, SEEK_SET);
  writeAll(file.get(), std::as_bytes(std::span(data, size)), "fuzz");
  if (::ftruncate(file.get(), static_cast<::off_t>(size)) != 0) std::abort();
  return FileDescriptor(::dup(file.get()));
}

}  // namespace broadmark::fuzz
