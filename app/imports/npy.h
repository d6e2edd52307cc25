// Boxes in NumPy's files: an array in a .npy file, or in a .npz archive, stored or deflated.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "broadmark/aabb.h"
#include "broadmark/files.h"
#include "imports/byte_reader.h"

namespace broadmark::imports {

/// Whether a file starts as one of these.
bool isNpy(std::string_view start);
bool isNpz(std::string_view start);

/// An array of shape (frames, bodies, 2, 3) or (frames, bodies, 6), or without the first dimension,
/// a single frame: min x, y, z, max x, y, z. Other numbers than 32-bit floats are rounded outward.
class NpyBoxes {
 public:
  /// Throws InputError.
  explicit NpyBoxes(const std::filesystem::path&);

  [[nodiscard]] std::uint32_t frames() const { return frames_; }
  [[nodiscard]] std::uint32_t bodies() const { return bodies_; }
  /// "array 'boxes' of <f8, shape (3, 100, 2, 3)"
  [[nodiscard]] const std::string& description() const { return description_; }

  /// Reads the boxes of a frame; absent bodies have infinite bounds, min above max. Throws
  /// InputError for other boxes than these and valid ones.
  void read(std::uint32_t frame, std::span<Aabb> boxes);

 private:
  /// A part of `reader_`'s file.
  struct Extent {
    std::uint64_t begin = 0;
    std::uint64_t size = 0;
  };
  [[nodiscard]] Extent openMember();
  [[nodiscard]] Extent centralDirectory();
  void inflateMember(Extent packed, std::uint64_t size, std::uint32_t checksum);
  void readHeader(Extent array);
  void setShape(std::string_view shape, Extent data);
  [[noreturn]] void fail(std::string_view what) const;

  /// A number, rounded down or up.
  float bound(bool up);

  std::filesystem::path path_;
  std::string member_;       ///< of an archive; "": none
  FileDescriptor inflated_;  ///< a deflated member's contents
  std::optional<ByteReader> reader_;
  std::string type_;  ///< without the byte order: "f4"
  std::endian order_ = std::endian::little;
  std::uint32_t frames_ = 0;
  std::uint32_t bodies_ = 0;
  std::uint64_t data_ = 0;  ///< offset of the first number
  std::uint64_t item_bytes_ = 0;
  std::string description_;
};

}  // namespace broadmark::imports
