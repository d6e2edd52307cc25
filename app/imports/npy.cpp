// The formats: numpy.lib.format (versions 1 to 3), and PKWARE's APPNOTE.TXT for archives.

#include "imports/npy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/exact_sum.h"
#include "broadmark/json_fields.h"
#include "support/contents.h"
#include "support/line_reader.h"

namespace broadmark::imports {
namespace {

constexpr std::string_view kNpyMagic = "\x93NUMPY";
constexpr std::string_view kNpzMagic = "PK\x03\x04";
constexpr std::uint64_t kBoxNumbers = 6;
constexpr std::uint32_t kMaxCount = std::numeric_limits<std::int32_t>::max();

// Records of an archive: their signatures, and bytes without names.
constexpr std::uint32_t kEndSignature = 0x06054b50;
constexpr std::uint32_t kEnd64Signature = 0x06064b50;
constexpr std::uint32_t kLocator64Signature = 0x07064b50;
constexpr std::uint32_t kEntrySignature = 0x02014b50;
constexpr std::uint32_t kLocalSignature = 0x04034b50;
constexpr std::uint64_t kEndBytes = 22;
constexpr std::uint64_t kLocator64Bytes = 20;
constexpr std::uint64_t kEntryBytes = 46;
constexpr std::uint64_t kLocalBytes = 30;
constexpr std::uint32_t kIn64Bits = 0xFFFFFFFF;  ///< the value is in an extra field

/// A member of an archive.
struct Entry {
  std::uint16_t flags = 0;
  std::uint16_t method = 0;
  std::uint32_t checksum = 0;
  std::uint64_t packed_size = 0;
  std::uint64_t size = 0;
  std::uint64_t local = 0;  ///< offset of its local header
  std::string name;
};

template <class Number>
Number little(ByteReader& reader) {
  return reader.number<Number>(std::endian::little, "the archive");
}

void skip(ByteReader& reader, std::uint64_t bytes) { reader.seek(reader.offset() + bytes); }

std::string textOf(ByteReader& reader, std::uint64_t bytes) {
  std::string text;
  for (std::uint64_t i = 0; i < bytes; ++i) {
    const int byte = reader.get();
    if (byte == ByteReader::kEnd) reader.failCutShort("a name");
    text += static_cast<char>(byte);
  }
  return text;
}

/// Reads an entry of the central directory.
Entry readEntry(ByteReader& reader) {
  if (little<std::uint32_t>(reader) != kEntrySignature) {
    reader.fail(reader.offset(), "not an entry of the archive's directory");
  }
  Entry entry;
  skip(reader, 4);
  entry.flags = little<std::uint16_t>(reader);
  entry.method = little<std::uint16_t>(reader);
  skip(reader, 4);
  entry.checksum = little<std::uint32_t>(reader);
  entry.packed_size = little<std::uint32_t>(reader);
  entry.size = little<std::uint32_t>(reader);
  const auto name_bytes = little<std::uint16_t>(reader);
  const auto extra_bytes = little<std::uint16_t>(reader);
  const auto comment_bytes = little<std::uint16_t>(reader);
  skip(reader, 8);
  entry.local = little<std::uint32_t>(reader);
  entry.name = textOf(reader, name_bytes);
  const std::uint64_t extra_end = reader.offset() + extra_bytes;
  while (reader.offset() + 4 <= extra_end) {
    const auto kind = little<std::uint16_t>(reader);
    const auto bytes = little<std::uint16_t>(reader);
    const std::uint64_t next = reader.offset() + bytes;
    constexpr std::uint16_t kSizes = 1;
    if (kind == kSizes) {
      for (std::uint64_t* value : {&entry.size, &entry.packed_size, &entry.local}) {
        if (*value == kIn64Bits) *value = little<std::uint64_t>(reader);
      }
    }
    reader.seek(next);
  }
  reader.seek(extra_end + comment_bytes);
  return entry;
}

/// What follows "'key':" in a header, which is a dictionary of Python.
std::string_view valueOf(std::string_view header, std::string_view key) {
  const std::string quoted_key = fmt::format("'{}':", key);
  const std::size_t at = header.find(quoted_key);
  return at == header.npos ? "" : trimmed(header.substr(at + quoted_key.size()));
}

}  // namespace

bool isNpy(std::string_view start) { return start.starts_with(kNpyMagic); }
bool isNpz(std::string_view start) { return start.starts_with(kNpzMagic); }

NpyBoxes::NpyBoxes(const std::filesystem::path& path) : path_(path) {
  reader_.emplace(path);
  const std::string start = startOf(path).text;
  if (isNpz(start)) {
    readHeader(openMember());
  } else {
    readHeader({0, reader_->bytesLeft()});
  }
}

void NpyBoxes::fail(std::string_view what) const {
  throw InputError(fmt::format("{}: {}{}", path_.string(),
                               member_.empty() ? "" : fmt::format("array '{}': ", member_), what));
}

NpyBoxes::Extent NpyBoxes::centralDirectory() {
  ByteReader& reader = *reader_;
  const std::uint64_t size = reader.bytesLeft();
  constexpr std::uint64_t kMaxComment = 0xFFFF;
  const std::uint64_t first = size - std::min(size, kEndBytes + kMaxComment);
  for (std::uint64_t at = size - std::min(size, kEndBytes); at + kEndBytes <= size; --at) {
    reader.seek(at);
    if (little<std::uint32_t>(reader) == kEndSignature) {
      skip(reader, 8);
      Extent directory{.size = little<std::uint32_t>(reader)};
      directory.begin = little<std::uint32_t>(reader);
      if (directory.begin != kIn64Bits) return directory;
      if (at < kLocator64Bytes) break;
      reader.seek(at - kLocator64Bytes);
      if (little<std::uint32_t>(reader) != kLocator64Signature) break;
      skip(reader, 4);
      reader.seek(little<std::uint64_t>(reader));
      if (little<std::uint32_t>(reader) != kEnd64Signature) break;
      skip(reader, 36);
      directory.size = little<std::uint64_t>(reader);
      directory.begin = little<std::uint64_t>(reader);
      return directory;
    }
    if (at == first) break;
  }
  fail("the archive has no directory: the file is cut short or damaged");
}

/// Finds the archive's array of boxes, and inflates it if necessary.
NpyBoxes::Extent NpyBoxes::openMember() {
  const std::uint64_t file_bytes = reader_->bytesLeft();
  const Extent directory = centralDirectory();
  if (directory.begin > file_bytes || directory.size > file_bytes - directory.begin) {
    fail("the archive's directory is beyond the end of the file");
  }
  std::map<std::string, Entry> arrays;
  reader_->seek(directory.begin);
  while (reader_->offset() + kEntryBytes <= directory.begin + directory.size) {
    Entry entry = readEntry(*reader_);
    constexpr std::string_view kExtension = ".npy";
    if (!entry.name.ends_with(kExtension)) continue;
    entry.name.resize(entry.name.size() - kExtension.size());
    arrays.insert_or_assign(entry.name, entry);
  }
  const auto named = arrays.size() == 1 ? arrays.begin() : arrays.find("boxes");
  if (named == arrays.end()) {
    std::vector<std::string> names;
    for (const auto& [name, entry] : arrays) names.push_back(onOneLine(name));
    fail(fmt::format("holds {}: a single array, or one named 'boxes', is expected",
                     names.empty() ? "no array" : fmt::format("{}", fmt::join(names, ", "))));
  }
  const Entry entry = named->second;
  member_ = onOneLine(entry.name);
  constexpr unsigned kEncrypted = 1;
  constexpr std::uint16_t kStored = 0;
  constexpr std::uint16_t kDeflated = 8;
  if ((entry.flags & kEncrypted) != 0) fail("is encrypted");
  if (entry.method != kStored && entry.method != kDeflated) {
    fail(fmt::format("is compressed by method {}: use numpy.savez or savez_compressed",
                     entry.method));
  }
  if (entry.local > file_bytes || file_bytes - entry.local < kLocalBytes) {
    fail("is beyond the end of the file");
  }
  reader_->seek(entry.local);
  if (little<std::uint32_t>(*reader_) != kLocalSignature) fail("is not where the directory says");
  skip(*reader_, 22);
  const auto name_bytes = little<std::uint16_t>(*reader_);
  const auto extra_bytes = little<std::uint16_t>(*reader_);
  const Extent packed{entry.local + kLocalBytes + name_bytes + extra_bytes, entry.packed_size};
  if (packed.begin > file_bytes || packed.size > file_bytes - packed.begin) {
    fail("is cut short");
  }
  if (entry.method == kStored) return packed;
  inflateMember(packed, entry.size, entry.checksum);
  return {0, entry.size};
}

void NpyBoxes::inflateMember(Extent packed, std::uint64_t size, std::uint32_t checksum) {
  const FileDescriptor file = openContents(path_);
  inflated_ = unnamedFile();
  z_stream stream{};
  constexpr int kRaw = -15;  // without a header of zlib's
  if (::inflateInit2(&stream, kRaw) != Z_OK) fail("out of memory");
  struct End {
    ~End() { ::inflateEnd(stream); }
    z_stream* stream;
  } const end{&stream};
  std::array<std::byte, 1 << 16> input;
  std::array<std::byte, 1 << 16> output;
  std::uint64_t read = 0;
  std::uint64_t written = 0;
  auto sum = static_cast<std::uint32_t>(::crc32(0, nullptr, 0));
  int status = Z_OK;
  bool more = false;  // there may be output of earlier input
  while (status != Z_STREAM_END) {
    if (stream.avail_in == 0 && !more) {
      const auto wanted = std::min<std::uint64_t>(input.size(), packed.size - read);
      const auto got = readAll(file.get(), std::span(input).first(wanted), packed.begin + read);
      if (got == 0) fail("its compressed data ends too early");
      read += got;
      stream.next_in = reinterpret_cast<Bytef*>(input.data());
      stream.avail_in = static_cast<uInt>(got);
    }
    stream.next_out = reinterpret_cast<Bytef*>(output.data());
    stream.avail_out = static_cast<uInt>(output.size());
    status = ::inflate(&stream, Z_NO_FLUSH);
    if (status == Z_BUF_ERROR && more) status = Z_OK;
    if (status != Z_OK && status != Z_STREAM_END) fail("its compressed data is damaged");
    more = stream.avail_out == 0;
    const std::size_t made = output.size() - stream.avail_out;
    written += made;
    if (written > size) fail("is larger than the archive's directory says");
    sum = static_cast<std::uint32_t>(
        ::crc32(sum, reinterpret_cast<const Bytef*>(output.data()), static_cast<uInt>(made)));
    writeAll(inflated_.get(), std::span(output).first(made), "an uncompressed file");
  }
  if (written != size || sum != checksum) fail("its checksum or size is wrong: it is damaged");
  reader_.emplace(fmt::format("/proc/self/fd/{}", inflated_.get()));
}

void NpyBoxes::readHeader(Extent array) {
  ByteReader& reader = *reader_;
  constexpr std::uint64_t kMinBytes = 12;
  constexpr std::uint32_t kMaxHeader = 1 << 16;
  reader.seek(array.begin);
  if (array.size < kMinBytes || textOf(reader, kNpyMagic.size()) != kNpyMagic) {
    fail("is not a NumPy array");
  }
  const int version = reader.get();
  reader.get();  // the minor version
  if (version < 1 || version > 3) {
    fail(fmt::format("version {} of NumPy's format: 1, 2 and 3 are read", version));
  }
  const std::uint32_t bytes = version == 1 ? reader.number<std::uint16_t>(std::endian::little, "")
                                           : little<std::uint32_t>(reader);
  const std::uint64_t begin = reader.offset();
  if (bytes > kMaxHeader || begin - array.begin + bytes > array.size)
    fail("its header is cut short");
  const std::string header = textOf(reader, bytes);
  const std::string_view type = valueOf(header, "descr");
  constexpr std::size_t kTypeChars = 5;  // '<f4'
  std::string plain(type.substr(0, kTypeChars));
  const bool is_quoted =
      plain.size() == kTypeChars && plain.front() == '\'' && plain.back() == '\'';
  constexpr std::array<std::string_view, 10> kTypes = {"f4", "f8", "i1", "i2", "i4",
                                                       "i8", "u1", "u2", "u4", "u8"};
  type_ = is_quoted ? plain.substr(2, 2) : "";
  if (std::ranges::find(kTypes, type_) == kTypes.end()) {
    fail(fmt::format("its type is {}: integers, or floats of 32 or 64 bits, are expected",
                     onOneLine(std::string(type.substr(0, type.find_first_of(",}"))))));
  }
  order_ = plain[1] == '>' ? std::endian::big : std::endian::little;
  item_bytes_ = static_cast<std::uint64_t>(type_[1] - '0');
  if (!valueOf(header, "fortran_order").starts_with("False")) {
    fail("is in Fortran order: save numpy.ascontiguousarray(boxes)");
  }
  data_ = begin + bytes;
  setShape(valueOf(header, "shape"), {data_, array.size - (data_ - array.begin)});
  description_ = fmt::format("array{} of {}", member_.empty() ? "" : fmt::format(" '{}'", member_),
                             plain.substr(1, 3));
}

void NpyBoxes::setShape(std::string_view shape, Extent data) {
  const std::size_t end = shape.find(')');
  const std::string text = onOneLine(std::string(shape.substr(0, std::min(end, shape.size()) + 1)));
  std::vector<std::uint64_t> sizes;
  std::vector<std::string_view> words;
  if (shape.starts_with('(') && end != shape.npos) splitCells(',', shape.substr(1, end - 1), words);
  for (const std::string_view word : words) {
    std::int64_t size = 0;
    if (trimmed(word).empty()) continue;  // after the last comma
    if (!parseInteger(trimmed(word), size) || size < 0) {
      fail(fmt::format("its shape is {}: a tuple of sizes is expected", text));
    }
    sizes.push_back(static_cast<std::uint64_t>(size));
  }
  if (sizes.size() >= 2 && sizes.back() == kBoxNumbers) {
    sizes.pop_back();
  } else if (sizes.size() >= 3 && sizes.back() == 3 && sizes[sizes.size() - 2] == 2) {
    sizes.resize(sizes.size() - 2);
  } else {
    sizes.clear();
  }
  if (sizes.size() == 1) sizes.insert(sizes.begin(), 1);
  if (sizes.size() != 2) {
    fail(fmt::format(
        "its shape is {}: (frames, bodies, 2, 3) or (frames, bodies, 6), with or without frames, "
        "is expected",
        text));
  }
  if (sizes[0] > kMaxCount || sizes[1] > kMaxCount) fail("more frames or bodies than 2^31 - 1");
  frames_ = static_cast<std::uint32_t>(sizes[0]);
  bodies_ = static_cast<std::uint32_t>(sizes[1]);
  if (frames_ == 0) fail(fmt::format("its shape is {}: it has no frame", text));
  if (sizes[0] * sizes[1] > data.size / (kBoxNumbers * item_bytes_)) {
    fail(fmt::format("is cut short: shape {} takes more than its {} bytes", text, data.size));
  }
}

float NpyBoxes::bound(bool up) {
  const auto rounded = [up](double high, double low) {
    return up ? floatAbove({high, low}) : floatBelow({high, low});
  };
  const auto whole = [&]<class Integer>(Integer) {
    const auto value = reader_->number<Integer>(order_, "the boxes");
    constexpr double kHalf = 4294967296.0;  // 64 bits are two numbers that doubles hold
    if constexpr (sizeof(Integer) < 8) {
      return rounded(static_cast<double>(value), 0);
    } else {
      return rounded(static_cast<double>(value >> 32) * kHalf,
                     static_cast<double>(static_cast<std::uint64_t>(value) & 0xFFFFFFFF));
    }
  };
  if (type_ == "f4") return reader_->number<float>(order_, "the boxes");
  if (type_ == "f8") {
    const auto value = reader_->number<double>(order_, "the boxes");
    return std::isfinite(value) ? rounded(value, 0) : static_cast<float>(value);
  }
  const bool is_signed = type_[0] == 'i';
  if (item_bytes_ == 1) return is_signed ? whole(std::int8_t{}) : whole(std::uint8_t{});
  if (item_bytes_ == 2) return is_signed ? whole(std::int16_t{}) : whole(std::uint16_t{});
  if (item_bytes_ == 4) return is_signed ? whole(std::int32_t{}) : whole(std::uint32_t{});
  return is_signed ? whole(std::int64_t{}) : whole(std::uint64_t{});
}

void NpyBoxes::read(std::uint32_t frame, std::span<Aabb> boxes) {
  reader_->seek(data_ + std::uint64_t{frame} * bodies_ * kBoxNumbers * item_bytes_);
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    Aabb box;
    for (int axis = 0; axis < 3; ++axis) box.min[axis] = bound(false);
    for (int axis = 0; axis < 3; ++axis) box.max[axis] = bound(true);
    boxes[body] = box;
    if (box == kEmptyBox) continue;
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis])) {
        fail(fmt::format("frame {}, body {}: {} to {} along {} is not finite in 32 bits", frame,
                         body, box.min[axis], box.max[axis], "xyz"[axis]));
      }
      if (box.min[axis] > box.max[axis]) {
        fail(fmt::format("frame {}, body {}: min {} is above max {} along {}", frame, body,
                         box.min[axis], box.max[axis], "xyz"[axis]));
      }
    }
  }
}

}  // namespace broadmark::imports
