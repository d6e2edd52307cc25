// Accessors of a glTF file, and the bytes that they view.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "imports/gltf_document.h"

namespace broadmark::imports::gltf {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);  // as in the files

/// Extensions of buffer views whose bytes are compressed.
constexpr std::array kCompressions = {"EXT_meshopt_compression", "KHR_meshopt_compression",
                                      "MESHOPT_compression"};

enum ComponentType {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126
};

std::uint32_t sizeOfComponent(std::uint64_t type) {
  switch (type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

/// Number of components of the types that are read here; 0 for others.
std::uint32_t componentsOf(std::string_view type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  if (type == "MAT4") return 16;
  return 0;
}

template <class T>
T loaded(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// Decodes "%20"; a '%' without two digits stands for itself.
std::string percentDecoded(std::string_view text) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_code =
        text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0;
    decoded += is_code ? static_cast<char>(digit(text[i + 1]) * 16 + digit(text[i + 2])) : text[i];
    if (is_code) i += 2;
  }
  return decoded;
}

/// Decodes base 64; nothing if it is damaged.
std::optional<std::string> base64Decoded(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
  }
  while (text.ends_with('=')) text.remove_suffix(1);
  if (text.size() % 4 == 1) return {};
  std::string decoded;
  decoded.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    const std::int8_t value = values[static_cast<unsigned char>(c)];
    if (value < 0) return {};
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    decoded += static_cast<char>(bits >> bit_count & 0xFF);
  }
  return decoded;
}

/// Whether a URI begins with a scheme: "http:".
bool hasScheme(std::string_view uri) {
  const std::size_t end = uri.find_first_of(":/");
  return end != std::string_view::npos && end > 1 && uri[end] == ':';
}

}  // namespace

double Accessor::component(const std::byte* bytes) const {
  const auto scaled = [&](auto value) {
    const auto number = static_cast<double>(value);
    if (!is_normalized_) return number;
    return std::max(number / static_cast<double>(std::numeric_limits<decltype(value)>::max()),
                    -1.0);
  };
  switch (component_type_) {
    case kByte:
      return scaled(loaded<std::int8_t>(bytes));
    case kUnsignedByte:
      return scaled(loaded<std::uint8_t>(bytes));
    case kShort:
      return scaled(loaded<std::int16_t>(bytes));
    case kUnsignedShort:
      return scaled(loaded<std::uint16_t>(bytes));
    case kUnsignedInt:
      return scaled(loaded<std::uint32_t>(bytes));
    default:
      return static_cast<double>(loaded<float>(bytes));
  }
}

void Accessor::read(std::uint32_t element, std::span<double> components) const {
  const std::byte* bytes = elements_ == nullptr ? nullptr : elements_ + stride_ * element;
  const auto sparse = std::ranges::lower_bound(sparse_indices_, element);
  if (sparse != sparse_indices_.end() && *sparse == element) {
    bytes = sparse_values_ +
            std::size_t{element_size_} * static_cast<std::size_t>(sparse - sparse_indices_.begin());
  }
  for (double& value : components) {
    value = bytes == nullptr ? 0 : component(bytes);
    if (bytes != nullptr) bytes += component_size_;
  }
}

double Accessor::number(std::uint32_t element) const {
  double value = 0;
  read(element, {&value, 1});
  return value;
}

const Accessor& Document::accessor(const JsonFields& object, const char* key,
                                   std::string_view type) {
  const std::uint32_t index = this->index(object, key, "accessors");
  auto known = accessors_.find(index);
  if (known == accessors_.end()) {
    known = accessors_.emplace(index, parseAccessor(item("accessors", index))).first;
  }
  if (known->second.type_ != type) {
    throw InputError(fmt::format("{}: {} is expected, not accessors[{}] of {}", object.path(key),
                                 type, index, known->second.type_));
  }
  return known->second;
}

const Accessor& Document::vertexIndices(const JsonFields& object, const char* key) {
  const Accessor& indices = accessor(object, key, "SCALAR");
  const int type = indices.component_type_;
  const bool is_valid = type == kUnsignedByte || type == kUnsignedShort || type == kUnsignedInt;
  if (!is_valid || indices.is_normalized_) {
    throw InputError(
        fmt::format("{}: indices must be unsigned integers, not normalized", indices.name));
  }
  return indices;
}

Accessor Document::parseAccessor(const JsonFields& object) {
  Accessor accessor;
  accessor.name = object.name();
  accessor.count = static_cast<std::uint32_t>(integer(object, "count", kMaxCount));
  const std::uint64_t type = integer(object, "componentType", kMaxCount);
  accessor.component_size_ = sizeOfComponent(type);
  if (accessor.component_size_ == 0) {
    fail(object,
         fmt::format("componentType {} is unknown: 5120 to 5123, 5125 or 5126 is expected", type));
  }
  accessor.component_type_ = static_cast<int>(type);
  accessor.type_ = object.text("type");
  const std::uint32_t components = componentsOf(accessor.type_);
  if (components == 0) {
    fail(object, fmt::format("type '{}' is not read here: SCALAR, VEC3, VEC4 or MAT4 is expected",
                             onOneLine(accessor.type_)));
  }
  accessor.element_size_ = accessor.component_size_ * components;
  accessor.is_normalized_ = object.has("normalized") && object.boolean("normalized");
  if (object.has("bufferView")) {
    accessor.stride_ = accessor.element_size_;
    const std::string_view bytes = bytesOf(object, &accessor.stride_);
    if (accessor.stride_ < accessor.element_size_) {
      fail(object, fmt::format("its elements have {} bytes, but the byteStride is {}",
                               accessor.element_size_, accessor.stride_));
    }
    const std::uint64_t needed =
        accessor.count == 0 ? 0 : accessor.stride_ * (accessor.count - 1) + accessor.element_size_;
    if (needed > bytes.size()) {
      fail(object, fmt::format("{} elements need {} bytes, but its buffer view has {}: cut short?",
                               accessor.count, needed, bytes.size()));
    }
    accessor.elements_ = reinterpret_cast<const std::byte*>(bytes.data());
  }
  if (object.has("sparse")) readSparse(object.object("sparse"), accessor);
  return accessor;
}

void Document::readSparse(const JsonFields& sparse, Accessor& accessor) {
  const auto count = static_cast<std::uint32_t>(integer(sparse, "count", accessor.count));
  const JsonFields indices = sparse.object("indices");
  const JsonFields values = sparse.object("values");
  const std::uint64_t type = integer(indices, "componentType", kMaxCount);
  if (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt) {
    fail(indices, fmt::format("componentType {}: 5121, 5123 or 5125 is expected", type));
  }
  const std::uint32_t index_size = sizeOfComponent(type);
  const std::string_view index_bytes = bytesOf(indices);
  const std::string_view value_bytes = bytesOf(values);
  if (std::uint64_t{count} * index_size > index_bytes.size()) {
    fail(indices, fmt::format("{} indices need {} bytes, but its buffer view has {}: cut short?",
                              count, std::uint64_t{count} * index_size, index_bytes.size()));
  }
  if (std::uint64_t{count} * accessor.element_size_ > value_bytes.size()) {
    fail(values,
         fmt::format("{} elements need {} bytes, but its buffer view has {}: cut short?", count,
                     std::uint64_t{count} * accessor.element_size_, value_bytes.size()));
  }
  charge(count, sizeof(std::uint32_t));
  Accessor list;
  list.component_type_ = static_cast<int>(type);
  const auto* bytes = reinterpret_cast<const std::byte*>(index_bytes.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto index =
        static_cast<std::uint32_t>(list.component(bytes + std::size_t{i} * index_size));
    if (index >= accessor.count) {
      fail(indices, fmt::format("index {}, but there are {} elements", index, accessor.count));
    }
    if (i > 0 && index <= accessor.sparse_indices_.back()) {
      fail(indices, fmt::format("index {} after {}: indices must ascend", index,
                                accessor.sparse_indices_.back()));
    }
    accessor.sparse_indices_.push_back(index);
  }
  accessor.sparse_values_ = reinterpret_cast<const std::byte*>(value_bytes.data());
}

// ---- Buffers.

std::string_view Document::bytesOf(const JsonFields& object, std::uint64_t* stride) {
  const JsonFields view = item("bufferViews", index(object, "bufferView", "bufferViews"));
  for (const char* compression : kCompressions) {
    if (!extension(view, compression)) continue;
    fail(view, fmt::format("its bytes are compressed with {}, which is not supported: export the "
                           "file without compression",
                           compression));
  }
  const std::uint32_t buffer_index = index(view, "buffer", "buffers");
  const std::string_view bytes = buffer(buffer_index);
  const std::uint64_t offset = integerOr(view, "byteOffset", 0, kMaxBytes);
  const std::uint64_t length = integer(view, "byteLength", kMaxBytes);
  if (offset > bytes.size() || length > bytes.size() - offset) {
    fail(view, fmt::format("{} bytes at {} are beyond buffers[{}], which has {}: cut short?",
                           length, offset, buffer_index, bytes.size()));
  }
  if (stride != nullptr) *stride = integerOr(view, "byteStride", *stride, 0xFFFF);
  const std::uint64_t start = integerOr(object, "byteOffset", 0, kMaxBytes);
  if (start > length) {
    fail(object,
         fmt::format("byteOffset {} is beyond its buffer view, which has {} bytes", start, length));
  }
  return bytes.substr(offset + start, length - start);
}

std::string_view Document::buffer(std::uint32_t index) {
  const JsonFields object = item("buffers", index);
  const std::uint64_t size = integer(object, "byteLength", kMaxBytes);
  std::string_view bytes;
  if (const auto known = buffers_.find(index); known != buffers_.end()) {
    bytes = known->second;
  } else if (object.has("uri")) {
    bytes = buffers_.emplace(index, readBuffer(object, object.text("uri"), size)).first->second;
    bytes_read_ += bytes.size();
  } else if (index == 0 && binary_chunk_) {
    bytes = *binary_chunk_;
  } else {
    fail(object, "has no bytes: neither a URI nor a binary chunk of the file");
  }
  if (size > bytes.size()) {
    fail(object,
         fmt::format("{} bytes are stated, but there are {}: cut short?", size, bytes.size()));
  }
  return bytes.substr(0, size);
}

std::string Document::readBuffer(const JsonFields& object, const std::string& uri,
                                 std::uint64_t size) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos) fail(object, "a data URI without a comma");
    std::string data = percentDecoded(std::string_view(uri).substr(comma + 1));
    if (!std::string_view(uri).substr(0, comma).ends_with(";base64")) return data;
    std::optional<std::string> decoded = base64Decoded(data);
    if (!decoded) fail(object, "a data URI with damaged base 64");
    return *std::move(decoded);
  }
  if (hasScheme(uri) || uri.starts_with('/')) {
    fail(object, fmt::format("'{}' is not read: the name of a file beside this one, or a data URI "
                             "is expected",
                             onOneLine(uri.substr(0, 80))));
  }
  const auto path_of = [&](const std::string& name) { return path_.parent_path() / name; };
  std::string name = percentDecoded(uri);
  std::error_code ignored;
  if (!fs::exists(path_of(name), ignored) && fs::exists(path_of(uri), ignored)) name = uri;
  const bool is_name = !name.empty() && name.find('\0') == std::string::npos;
  if (!is_name || fs::path(name).is_absolute()) fail(object, "the URI is not the name of a file");
  try {
    std::string bytes = readBytes(path_of(name));
    // A longer file is no damage, but need not stay in memory.
    if (bytes.size() > size) bytes.resize(size);
    return bytes;
  } catch (const InputError& error) {
    fail(object, onOneLine(error.what()));
  }
}

}  // namespace broadmark::imports::gltf
