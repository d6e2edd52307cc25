#include "imports/line_reader.h"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/json_fields.h"
#include "support/words.h"

namespace broadmark::imports {
namespace {

constexpr std::string_view kWhiteSpace = " \t\v\f";
/// Longer lines indicate a binary file.
constexpr std::size_t kMaxLineLength = 1 << 20;

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kWhiteSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kWhiteSpace) + 1 - begin);
}

/// Quotes and truncates a word for a message.
std::string quoted(std::string_view text) {
  constexpr std::size_t kMaxLength = 40;
  const bool cut = text.size() > kMaxLength;
  return fmt::format("'{}{}'", onOneLine(std::string(text.substr(0, kMaxLength))), cut ? "…" : "");
}

/// Parses a text that is a number and nothing else.
template <class Number>
bool parse(std::string_view text, Number& number) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && rest == end;
}

}  // namespace

LineReader::LineReader(const std::filesystem::path& path)
    : path_(path.string()), buffer_(kMaxLineLength + 2, '\0') {
  openForReading(path);  // throws unless it is a regular file
  file_.open(path);
}

bool LineReader::next() {
  if (std::exchange(unread_, false)) return true;
  file_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  const auto length = static_cast<std::size_t>(file_.gcount());
  if (file_.bad()) {
    throw InputError(fmt::format("{}: cannot read: {}", path_, std::strerror(errno)));
  }
  if (length == 0) return false;
  begin_ += length_;
  length_ = length;
  ++number_;
  if (file_.fail()) fail("is longer than a million characters: not a text file?");
  line_ = std::string_view(buffer_).substr(0, file_.eof() ? length : length - 1);
  while (line_.ends_with('\r')) line_.remove_suffix(1);
  return true;
}

void LineReader::require(std::string_view expected) {
  if (next()) return;
  throw InputError(fmt::format("{}: ends after line {}: {} is expected", path_, number_, expected));
}

LineReader::Position LineReader::position() const {
  if (unread_) return {begin_, number_ - 1};
  return {begin_ + length_, number_};
}

void LineReader::seek(Position position) {
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(position.offset));
  begin_ = position.offset;
  length_ = 0;
  number_ = position.lines_before;
  unread_ = false;
}

void LineReader::fail(std::uint64_t line, std::string_view what) const {
  throw InputError(fmt::format("{}: line {}: {}", path_, line, what));
}

double LineReader::realNumber(std::string_view text, std::string_view what) const {
  double number = 0;
  if (!parse(text, number) || !std::isfinite(number)) {
    fail(fmt::format("{} is {}: a finite number is expected", what, quoted(text)));
  }
  return number;
}

std::int64_t LineReader::integer(std::string_view text, std::string_view what) const {
  std::int64_t number = 0;
  if (!parse(text, number)) {
    fail(fmt::format("{} is {}: an integer is expected", what, quoted(text)));
  }
  return number;
}

bool isBlank(std::string_view line) { return trimmed(line).empty(); }

void splitWords(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  for (std::size_t begin = line.find_first_not_of(kWhiteSpace); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kWhiteSpace, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kWhiteSpace, end);
  }
}

void splitCells(char separator, std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  forEachPart(separator, line, [&](std::string_view part) { cells.push_back(trimmed(part)); });
}

}  // namespace broadmark::imports
