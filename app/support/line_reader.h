// Reads a text file line by line, and parses lines, the same in every locale. Errors are
// InputErrors that name the file and the line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/files.h"

namespace broadmark::imports {

/// In UTF-8.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The file may start with a byte order mark, be compressed by gzip, or be a pipe (contents.h).
class LineReader {
 public:
  explicit LineReader(const std::filesystem::path& path);

  /// Calls `on_read` whenever more of the file is read, with the completed fraction.
  void watch(std::function<void(double fraction)> on_read);

  /// Reads the next line, without its end: LF, CR LF or CR. Returns false at the end of the file.
  bool next();
  /// Like next(), but throws at the end of the file, stating what is `expected`.
  void require(std::string_view expected);
  /// Makes next() return the current line again.
  void unread() { unread_ = true; }

  /// Current line, valid until the next one is read.
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::uint64_t number() const { return number_; }

  /// Start of a line.
  struct Position {
    std::uint64_t offset = 0;
    std::uint64_t lines_before = 0;
  };
  /// Position of the line that next() will return.
  [[nodiscard]] Position position() const;
  void seek(Position position);

  /// Throws InputError about the current line.
  [[noreturn]] void fail(std::string_view what) const { fail(number_, what); }
  /// Same about another line.
  [[noreturn]] void fail(std::uint64_t line, std::string_view what) const;

  /// Parses a number. Throws InputError, calling the number `what`.
  [[nodiscard]] double realNumber(std::string_view text, std::string_view what) const;
  [[nodiscard]] std::int64_t integer(std::string_view text, std::string_view what) const;

 private:
  /// Discards the buffer before `begin`, and reads more behind it. Returns false at the end of the
  /// file.
  bool fill(std::size_t begin);

  std::string path_;
  FileDescriptor file_;
  std::function<void(double fraction)> on_read_;
  double size_ = 1;  ///< of the file in bytes, if it is watched
  char line_end_ = '\n';
  std::string buffer_;  ///< the first `filled_` bytes are of the file
  std::size_t filled_ = 0;
  std::uint64_t buffer_begin_ = 0;  ///< its offset in the file
  std::string_view line_;
  std::uint64_t begin_ = 0;   ///< offset of the current line in the file
  std::uint64_t length_ = 0;  ///< of the current line, including its end
  std::uint64_t number_ = 0;
  bool unread_ = false;
};

/// The number that a text is, and nothing else. Numbers too small for a double are 0 or denormal.
bool parseReal(std::string_view text, double& number);
bool parseInteger(std::string_view text, std::int64_t& number);

/// Whether a line contains only white space.
bool isBlank(std::string_view line);
/// The text without white space around it.
std::string_view trimmed(std::string_view text);
/// The text with ASCII letters in lower case.
std::string lowered(std::string_view text);
/// Splits a line at white space.
void splitWords(std::string_view line, std::vector<std::string_view>& words);
/// Splits a line at separators, and removes white space around the parts.
void splitCells(char separator, std::string_view line, std::vector<std::string_view>& cells);
/// Quotes and truncates a word for a message.
std::string quoted(std::string_view text);

}  // namespace broadmark::imports
