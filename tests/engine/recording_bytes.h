// Recordings as bytes, for hand-made and invalid files.
#pragma once

#include <sys/mman.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "broadmark/files.h"
#include "broadmark/frame.h"
#include "engine/helpers.h"

namespace broadmark::tests {

using Bytes = std::vector<unsigned char>;

inline void putInt(Bytes& bytes, std::size_t offset, std::int32_t value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

inline void putFloat(Bytes& bytes, std::size_t offset, float value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

/// Appends floats in their file format.
inline void append(Bytes& bytes, const std::vector<float>& values) {
  const auto* raw = reinterpret_cast<const unsigned char*>(values.data());
  bytes.insert(bytes.end(), raw, raw + values.size() * sizeof(float));
}

inline Bytes bytesOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A reader of these bytes; `name` is the file name in messages.
template <class Reader>
Reader readerOf(const Bytes& bytes, const std::string& name) {
  FileDescriptor file(::memfd_create("recording", 0));
  writeAll(file.get(), std::as_bytes(std::span(bytes)), "memory");
  return {std::move(file), name};
}

/// The error of reading a recording with these bytes to its end.
template <class Reader>
std::string faultOf(const Bytes& bytes, const std::string& name) {
  return inputErrorOf([&] {
    auto reader = readerOf<Reader>(bytes, name);
    reader.rewind();
    while (reader.next()) {
    }
  });
}

}  // namespace broadmark::tests
