// Reads a file byte by byte: binary numbers, and words of text. Errors are InputErrors that name
// the file, and the byte or the line.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/files.h"

namespace broadmark::imports {

class ByteReader {
 public:
  explicit ByteReader(const std::filesystem::path& path);

  /// Returned instead of a byte at the end of the file.
  static constexpr int kEnd = -1;
  [[nodiscard]] int peek() {
    return position_ == filled_ && !refill(1) ? kEnd : std::to_integer<int>(buffer_[position_]);
  }
  int get();

  [[nodiscard]] std::uint64_t offset() const { return begin_ + position_; }
  [[nodiscard]] std::uint64_t bytesLeft() const { return size_ - std::min(size_, offset()); }
  /// Continues at another byte. Lines are counted from there on.
  void seek(std::uint64_t offset);

  /// Reads a binary number. Throws at the end of the file, stating what it is part of.
  template <class Number>
  Number number(std::endian order, std::string_view what) {
    if (filled_ - position_ < sizeof(Number) && !refill(sizeof(Number))) failCutShort(what);
    std::array<std::byte, sizeof(Number)> bytes;
    std::memcpy(bytes.data(), buffer_.data() + position_, bytes.size());
    position_ += bytes.size();
    if (order != std::endian::native) std::ranges::reverse(bytes);
    return std::bit_cast<Number>(bytes);
  }

  // Text. Lines end with LF, CRLF or CR.

  /// Skips a byte order mark at the start of the file.
  void skipByteOrderMark();
  /// Reads the next word, on this line or a later one; empty at the end of the file. Valid until
  /// the next one is read.
  std::string_view word();
  /// Same for a finite number, which errors call `what`.
  double realNumber(std::string_view what);
  /// Whether only white space follows on this line.
  [[nodiscard]] bool atLineEnd();
  void skipLine();

  /// Throws InputError about byte `offset`.
  [[noreturn]] void fail(std::uint64_t offset, std::string_view what) const;
  /// Throws InputError about the last word.
  [[noreturn]] void failAtWord(std::string_view what) const;
  /// Throws InputError: the file ends within `what`.
  [[noreturn]] void failCutShort(std::string_view what) const;

 private:
  /// Fills the buffer from the current byte on. Returns whether it holds `bytes` bytes.
  bool refill(std::size_t bytes);
  void skipBlanks();
  void skipSpace();

  std::string path_;
  FileDescriptor file_;
  std::uint64_t size_ = 0;
  std::vector<std::byte> buffer_;
  std::uint64_t begin_ = 0;   ///< offset of the buffer in the file
  std::size_t position_ = 0;  ///< of the next byte in the buffer
  std::size_t filled_ = 0;
  std::uint64_t line_ = 1;
  bool after_return_ = false;  ///< the last byte was a carriage return
  std::string word_;
  std::uint64_t word_offset_ = 0;
  std::uint64_t word_line_ = 1;
};

/// Whether two words are equal in any case.
bool sameWord(std::string_view a, std::string_view b);

}  // namespace broadmark::imports
