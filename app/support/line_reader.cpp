#include "support/line_reader.h"

#include <fmt/format.h>

#include <locale.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <span>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/json_fields.h"
#include "support/contents.h"
#include "support/words.h"

namespace broadmark::imports {
namespace {

constexpr std::string_view kWhiteSpace = " \t\v\f";
/// Longer lines indicate a binary file.
constexpr std::size_t kMaxLineLength = 1 << 20;
constexpr std::size_t kFirstBytes = 1 << 16;

/// Parses what from_chars() calls out of range, a correct number: 0 or denormal, or infinite.
double hugeOrTiny(const std::string& text) {
  static const locale_t c_locale = ::newlocale(LC_ALL_MASK, "C", nullptr);
  return ::strtod_l(text.c_str(), nullptr, c_locale);
}

/// Without a plus sign, which from_chars() does not accept.
std::string_view withoutPlus(std::string_view text) {
  const bool plus = text.starts_with('+') && !text.starts_with("+-");
  return plus ? text.substr(1) : text;
}

}  // namespace

LineReader::LineReader(const std::filesystem::path& path)
    : path_(path.string()), file_(openContents(path)), buffer_(kFirstBytes, '\0') {
  fill(0);
  const std::string_view start = std::string_view(buffer_).substr(0, filled_);
  if (start.starts_with("\xFF\xFE") || start.starts_with("\xFE\xFF")) {
    throw InputError(fmt::format("{}: is UTF-16: save it as UTF-8", path_));
  }
  if (start.starts_with(kByteOrderMark)) begin_ = kByteOrderMark.size();
  const bool has_lf = start.find('\n') != std::string_view::npos;
  if (!has_lf && start.find('\r') != std::string_view::npos) line_end_ = '\r';
}

void LineReader::watch(std::function<void(double fraction)> on_read) {
  struct stat status = {};
  ::fstat(file_.get(), &status);
  size_ = static_cast<double>(std::max<off_t>(status.st_size, 1));
  on_read_ = std::move(on_read);
}

bool LineReader::fill(std::size_t begin) {
  if (begin > 0) {
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin),
              buffer_.begin() + static_cast<std::ptrdiff_t>(filled_), buffer_.begin());
    filled_ -= begin;
    buffer_begin_ += begin;
  }
  if (filled_ == buffer_.size()) buffer_.resize(2 * buffer_.size());
  const std::span space = std::span(buffer_).subspan(filled_);
  const std::size_t got =
      readAll(file_.get(), std::as_writable_bytes(space), buffer_begin_ + filled_);
  if (got < space.size() && errno != 0) {
    throw InputError(fmt::format("{}: cannot read: {}", path_, std::strerror(errno)));
  }
  filled_ += got;
  if (on_read_) on_read_(static_cast<double>(buffer_begin_ + filled_) / size_);
  return got > 0;
}

bool LineReader::next() {
  if (std::exchange(unread_, false)) return true;
  begin_ += length_;
  length_ = 0;
  std::size_t begin = begin_ - buffer_begin_;
  std::size_t end = begin;
  while (true) {
    const void* found = std::memchr(buffer_.data() + end, line_end_, filled_ - end);
    if (found != nullptr) {
      end = static_cast<std::size_t>(static_cast<const char*>(found) - buffer_.data());
      length_ = end + 1 - begin;
      break;
    }
    if (filled_ - begin > kMaxLineLength) {
      fail(number_ + 1, "is longer than a million characters: not a text file?");
    }
    end = filled_ - begin;  // all up to here has been searched
    const bool more = fill(begin);
    begin = 0;
    if (!more) {
      length_ = end;
      break;
    }
  }
  if (length_ == 0) return false;
  ++number_;
  line_ = std::string_view(buffer_).substr(begin, end - begin);
  while (line_.ends_with('\r')) line_.remove_suffix(1);
  // A file pasted together may have other line ends, too.
  const char other = line_end_ == '\n' ? '\r' : '\n';
  if (const std::size_t found = line_.find(other); found != std::string_view::npos) {
    length_ = found + 1;
    line_ = line_.substr(0, found);
  }
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
  begin_ = position.offset;
  length_ = 0;
  number_ = position.lines_before;
  unread_ = false;
  if (begin_ >= buffer_begin_ && begin_ <= buffer_begin_ + filled_) return;
  buffer_begin_ = begin_;
  filled_ = 0;
}

void LineReader::fail(std::uint64_t line, std::string_view what) const {
  throw InputError(fmt::format("{}: line {}: {}", path_, line, what));
}

double LineReader::realNumber(std::string_view text, std::string_view what) const {
  double number = 0;
  if (!parseReal(text, number) || !std::isfinite(number)) {
    fail(fmt::format("{} is {}: a finite number is expected", what, quoted(text)));
  }
  return number;
}

std::int64_t LineReader::integer(std::string_view text, std::string_view what) const {
  std::int64_t number = 0;
  if (parseInteger(text, number)) return number;
  // Programs whose tables hold floats write "3.0" or "3e+00".
  constexpr double kMaxExact = 1LL << 53;
  double real = 0;
  if (!parseReal(text, real) || !(std::abs(real) <= kMaxExact) || real != std::floor(real)) {
    fail(fmt::format("{} is {}: an integer is expected", what, quoted(text)));
  }
  return static_cast<std::int64_t>(real);
}

bool parseReal(std::string_view text, double& number) {
  text = withoutPlus(text);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc::result_out_of_range) number = hugeOrTiny(std::string(text));
  return error != std::errc::invalid_argument && end == text.data() + text.size();
}

bool parseInteger(std::string_view text, std::int64_t& number) {
  text = withoutPlus(text);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kWhiteSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kWhiteSpace) + 1 - begin);
}

std::string lowered(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kMaxLength = 40;
  const bool cut = text.size() > kMaxLength;
  return fmt::format("'{}{}'", onOneLine(std::string(text.substr(0, kMaxLength))), cut ? "…" : "");
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
