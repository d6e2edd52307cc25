#include "imports/byte_reader.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cmath>

#include "broadmark/error.h"
#include "broadmark/json_fields.h"
#include "support/contents.h"
#include "support/line_reader.h"

namespace broadmark::imports {
namespace {

constexpr std::size_t kBufferBytes = 1 << 16;

bool isBlankByte(int byte) { return byte == ' ' || byte == '\t' || byte == '\v' || byte == '\f'; }
bool isLineEnd(int byte) { return byte == '\n' || byte == '\r'; }

}  // namespace

ByteReader::ByteReader(const std::filesystem::path& path)
    : path_(path.string()), file_(openContents(path)), buffer_(kBufferBytes) {
  struct stat status{};
  if (::fstat(file_.get(), &status) == 0) size_ = static_cast<std::uint64_t>(status.st_size);
}

bool ByteReader::refill(std::size_t bytes) {
  begin_ += position_;
  position_ = 0;
  filled_ = readAll(file_.get(), buffer_, begin_);
  if (filled_ < buffer_.size() && errno != 0) {
    throw InputError(fmt::format("{}: cannot read: {}", path_, std::strerror(errno)));
  }
  return filled_ >= bytes;
}

int ByteReader::get() {
  const int byte = peek();
  if (byte == kEnd) return kEnd;
  ++position_;
  if (byte == '\n' ? !after_return_ : byte == '\r') ++line_;
  after_return_ = byte == '\r';
  return byte;
}

void ByteReader::seek(std::uint64_t offset) {
  begin_ = offset;
  position_ = 0;
  filled_ = 0;
  line_ = 1;
  after_return_ = false;
}

void ByteReader::skipByteOrderMark() {
  for (const int byte : {0xEF, 0xBB, 0xBF}) {
    if (peek() != byte) return seek(0);
    get();
  }
}

void ByteReader::skipBlanks() {
  while (isBlankByte(peek())) get();
}

void ByteReader::skipSpace() {
  while (isBlankByte(peek()) || isLineEnd(peek())) get();
}

bool ByteReader::atLineEnd() {
  skipBlanks();
  return peek() == kEnd || isLineEnd(peek());
}

void ByteReader::skipLine() {
  while (peek() != kEnd && !isLineEnd(peek())) get();
}

std::string_view ByteReader::word() {
  constexpr std::size_t kMaxWordLength = 4096;
  skipSpace();
  word_.clear();
  word_offset_ = offset();
  word_line_ = line_;
  for (int byte = peek(); byte != kEnd && !isBlankByte(byte) && !isLineEnd(byte); byte = peek()) {
    if (word_.size() == kMaxWordLength) {
      failAtWord(fmt::format("a word of more than {} characters: not a text file?", word_.size()));
    }
    word_.push_back(static_cast<char>(get()));
  }
  return word_;
}

double ByteReader::realNumber(std::string_view what) {
  const std::string_view text = word();
  if (text.empty()) failCutShort(what);
  double number = 0;
  if (!parseReal(text, number) || !std::isfinite(number)) {
    failAtWord(fmt::format("{} is '{}': a finite number is expected", what,
                           onOneLine(std::string(text.substr(0, 40)))));
  }
  return number;
}

void ByteReader::fail(std::uint64_t offset, std::string_view what) const {
  throw InputError(fmt::format("{}: byte {}: {}", path_, offset, what));
}

void ByteReader::failAtWord(std::string_view what) const {
  throw InputError(fmt::format("{}: line {}, byte {}: {}", path_, word_line_, word_offset_, what));
}

void ByteReader::failCutShort(std::string_view what) const {
  fail(size_, fmt::format("the file ends within {}: cut short?", what));
}

bool sameWord(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

}  // namespace broadmark::imports
