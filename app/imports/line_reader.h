// A text file, line by line, and what stands in a line. Whatever is wrong is an InputError that
// names the file and the line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark::imports {

class LineReader {
 public:
  explicit LineReader(const std::filesystem::path& path);

  /// Goes to the next line; false at the end of the file. Carriage returns at its end are left out.
  bool next();
  /// As next(), but throws at the end of the file; `expected` is what would be right.
  void require(std::string_view expected);
  /// Lets next() give this line once more.
  void again() { again_ = true; }

  /// The present line, until the next one is read.
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::uint64_t number() const { return number_; }

  /// Where a line begins.
  struct Position {
    std::uint64_t offset = 0;
    std::uint64_t lines_before = 0;
  };
  /// Of the line that next() gives.
  [[nodiscard]] Position place() const;
  void seek(Position place);

  /// Throws InputError about the present line.
  [[noreturn]] void fail(std::string_view what) const { fail(number_, what); }
  /// The same about another one.
  [[noreturn]] void fail(std::uint64_t line, std::string_view what) const;

  /// The number that `text` is. Throws InputError; `what` stands for it.
  [[nodiscard]] double realNumber(std::string_view text, std::string_view what) const;
  [[nodiscard]] std::int64_t integer(std::string_view text, std::string_view what) const;

 private:
  std::string path_;
  std::ifstream file_;
  std::string buffer_;
  std::string_view line_;
  std::uint64_t begin_ = 0;   ///< of the present line, in the file
  std::uint64_t length_ = 0;  ///< of the present line, with its end
  std::uint64_t number_ = 0;
  bool again_ = false;
};

/// Whether there is nothing but white space.
bool isBlank(std::string_view line);
/// What stands between white space in a line.
void splitWords(std::string_view line, std::vector<std::string_view>& words);
/// The parts of a line between separators, without white space around them.
void splitCells(char separator, std::string_view line, std::vector<std::string_view>& cells);

}  // namespace broadmark::imports
