#include "imports/line_reader.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "broadmark/error.h"
#include "broadmark/json_fields.h"

namespace broadmark::imports {
namespace {

constexpr std::string_view kWhiteSpace = " \t\v\f";
/// A longer line is no line of text.
constexpr std::size_t kLongestLine = 1 << 20;

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kWhiteSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kWhiteSpace) + 1 - begin);
}

/// A word as it can stand in a message.
std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  const bool cut = text.size() > kMost;
  return fmt::format("'{}{}'", onOneLine(std::string(text.substr(0, kMost))), cut ? "…" : "");
}

/// The number that the whole text is.
template <class Number>
bool parse(std::string_view text, Number& number) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && rest == end;
}

}  // namespace

LineReader::LineReader(const std::filesystem::path& path)
    : path_(path.string()), file_(openForReading(path)) {}

bool LineReader::fill() {
  buffer_offset_ += buffer_.size();
  used_ = 0;
  buffer_.resize(1 << 16);
  ssize_t got = -1;
  do {
    got = ::pread(file_.get(), buffer_.data(), buffer_.size(), static_cast<off_t>(buffer_offset_));
  } while (got < 0 && errno == EINTR);
  buffer_.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  if (got < 0) throw InputError(fmt::format("{}: cannot read: {}", path_, std::strerror(errno)));
  return got > 0;
}

bool LineReader::next() {
  if (again_) {
    again_ = false;
    return true;
  }
  const Place here = place();
  line_.clear();
  bool any = false;
  while (used_ < buffer_.size() || fill()) {
    any = true;
    const std::string_view rest = std::string_view(buffer_).substr(used_);
    const std::size_t end = rest.find('\n');
    line_ += rest.substr(0, end);
    used_ += std::min(end, rest.size());
    if (line_.size() > kLongestLine) {
      number_ = here.lines_before + 1;
      fail("is longer than a million characters: not a text file?");
    }
    if (end == std::string_view::npos) continue;
    ++used_;
    break;
  }
  if (!any) return false;
  while (line_.ends_with('\r')) line_.pop_back();
  begin_ = here.offset;
  number_ = here.lines_before + 1;
  return true;
}

void LineReader::require(std::string_view expected) {
  if (next()) return;
  throw InputError(fmt::format("{}: ends after line {}: {} is expected", path_, number_, expected));
}

LineReader::Place LineReader::place() const {
  if (again_) return {begin_, number_ - 1};
  return {buffer_offset_ + used_, number_};
}

void LineReader::seek(Place place) {
  buffer_.clear();
  used_ = 0;
  buffer_offset_ = place.offset;
  number_ = place.lines_before;
  again_ = false;
}

void LineReader::fail(std::uint64_t line, std::string_view what) const {
  throw InputError(fmt::format("{}: line {}: {}", path_, line, what));
}

double LineReader::realNumber(std::string_view text, std::string_view what) const {
  double number = 0;
  if (!parse(text, number) || !std::isfinite(number)) {
    fail(fmt::format("{} is {}: a finite number is expected", what, shown(text)));
  }
  return number;
}

std::int64_t LineReader::integer(std::string_view text, std::string_view what) const {
  std::int64_t number = 0;
  if (!parse(text, number)) {
    fail(fmt::format("{} is {}: an integer is expected", what, shown(text)));
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

void splitCommas(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
}

}  // namespace broadmark::imports
