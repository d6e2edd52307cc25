#include "imports/gltf_document.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "broadmark/files.h"
#include "support/contents.h"

namespace broadmark::imports::gltf {
namespace {

namespace fs = std::filesystem;

/// Whether an extension concerns how bodies look, not where they are.
bool isOfLooks(std::string_view name) {
  constexpr std::array<std::string_view, 8> kPrefixes = {
      "KHR_materials_", "EXT_materials_", "KHR_texture_", "EXT_texture_",
      "MSFT_texture_",  "KHR_lights_",    "EXT_lights_",  "KHR_xmp"};
  return std::ranges::any_of(kPrefixes,
                             [&](std::string_view prefix) { return name.starts_with(prefix); });
}
bool isSupported(std::string_view name) {
  return name == "KHR_mesh_quantization" || name == "EXT_mesh_gpu_instancing" ||
         name == "KHR_node_visibility" || isOfLooks(name);
}

}  // namespace

std::string readBytes(const fs::path& path) {
  const FileDescriptor file = openContents(path);
  struct stat status{};
  const bool known = ::fstat(file.get(), &status) == 0;
  std::string bytes(known ? static_cast<std::size_t>(status.st_size) : 0, '\0');
  if (!known || readAll(file.get(), std::as_writable_bytes(std::span(bytes)), 0) < bytes.size()) {
    throw InputError(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
  }
  return bytes;
}

void fail(const JsonFields& object, std::string_view what) {
  throw InputError(fmt::format("{}: {}", object.name(), what));
}

std::uint64_t integer(const JsonFields& object, const char* key, std::uint64_t max) {
  const Json& value = object.at(key);
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= max) {
    return value.get<std::uint64_t>();
  }
  constexpr double kMaxExact = 1LL << 53;
  const double number = value.is_number_float() ? value.get<double>() : -1;
  if (number >= 0 && number <= kMaxExact && number == std::floor(number) &&
      static_cast<std::uint64_t>(number) <= max) {
    return static_cast<std::uint64_t>(number);
  }
  throw InputError(fmt::format("{}: an integer from 0 to {} is expected, not {}", object.path(key),
                               max, onOneLine(compactJson(value).substr(0, 40))));
}

std::uint64_t integerOr(const JsonFields& object, const char* key, std::uint64_t fallback,
                        std::uint64_t max) {
  return object.has(key) ? integer(object, key, max) : fallback;
}

std::vector<double> numbers(const JsonFields& object, const char* key) {
  std::vector<double> values;
  for (const Json& value : object.array(key)) {
    if (!value.is_number()) throw InputError(object.path(key) + ": numbers are expected");
    values.push_back(value.get<double>());
  }
  return values;
}

std::string textOr(const JsonFields& object, const char* key) {
  return object.has(key) ? object.text(key) : std::string();
}

std::optional<JsonFields> extension(const JsonFields& object, const char* name) {
  if (!object.has("extensions")) return {};
  const JsonFields all = object.object("extensions");
  if (!all.has(name)) return {};
  return all.object(name);
}

Document::Document(const fs::path& file, std::uint64_t spare_bytes, ImportSummary& summary)
    : path_(file), name_(file.string()), file_(readBytes(file)), spare_bytes_(spare_bytes) {
  bytes_read_ = file_.size();
  summary.format = "glTF 2.0";
  if (file_.starts_with("glTF")) {
    summary.format = "binary glTF 2.0";
    readBinary(file_, summary);
  } else {
    json_ = parseJson(file_, name_);
  }
  root_.emplace(json_, name_);
  requireVersion();
  requireExtensions(summary);
}

void Document::readBinary(std::string_view bytes, ImportSummary& summary) {
  constexpr std::size_t kHeader = 12;
  constexpr std::size_t kChunkHeader = 8;
  constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
  constexpr std::uint32_t kBinaryChunk = 0x004E4942;
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}: {}", name_, what));
  };
  if (bytes.size() < kHeader) refuse("the header of a binary glTF file is cut short");
  if (number(4) != 2) refuse(fmt::format("binary glTF of version {}: 2 is expected", number(4)));
  const std::size_t length = number(8);
  if (length > bytes.size()) {
    refuse(fmt::format("{} bytes are stated, but there are {}: cut short?", length, bytes.size()));
  }
  if (length < bytes.size()) {
    addOnce(summary.left_out, fmt::format("{} bytes after the end", bytes.size() - length));
  }
  bytes = bytes.substr(0, length);
  std::optional<std::string_view> text;
  for (std::size_t at = kHeader; at < bytes.size();) {
    if (bytes.size() - at < kChunkHeader) refuse(fmt::format("the chunk at {} is cut short", at));
    const std::size_t size = number(at);
    const std::uint32_t type = number(at + 4);
    at += kChunkHeader;
    if (size > bytes.size() - at) {
      refuse(fmt::format("the chunk at {} has {} bytes, but {} are left: cut short?",
                         at - kChunkHeader, size, bytes.size() - at));
    }
    const std::string_view chunk = bytes.substr(at, size);
    if (!text && type != kJsonChunk) refuse("its first chunk is not JSON");
    if (!text) {
      text = chunk;
    } else if (type == kBinaryChunk && !binary_chunk_) {
      binary_chunk_ = chunk;
    }
    at += size;
  }
  if (!text) refuse("has no JSON chunk");
  json_ = parseJson(text->substr(0, text->find_last_not_of('\0') + 1), name_);
}

void Document::requireVersion() const {
  const JsonFields asset = root().object("asset");
  const std::string version = asset.text("version");
  const std::string min_version = textOr(asset, "minVersion");
  if (!version.starts_with("2.") || (!min_version.empty() && min_version != "2.0")) {
    fail(asset, fmt::format("glTF {}: 2.0 is expected",
                            onOneLine(min_version.empty() ? version : min_version)));
  }
}

void Document::requireExtensions(ImportSummary& summary) const {
  if (root().has("extensionsRequired")) {
    for (const std::string& name : root().texts("extensionsRequired")) {
      if (isSupported(name)) continue;
      fail(root(), fmt::format("requires the extension {}, which is not supported: export the file "
                               "without it",
                               onOneLine(name)));
    }
  }
  if (!root().has("extensionsUsed")) return;
  for (const std::string& name : root().texts("extensionsUsed")) {
    if (!isSupported(name)) addOnce(summary.left_out, "extension " + onOneLine(name));
  }
}

std::uint32_t Document::count(const char* list) const {
  if (!root().has(list)) return 0;
  const std::size_t size = root().array(list).size();
  if (size > kMaxCount) fail(root(), fmt::format("too many {}", list));
  return static_cast<std::uint32_t>(size);
}

JsonFields Document::item(const char* list, std::uint32_t index) const {
  return {root().array(list)[index], fmt::format("{}: {}[{}]", name_, list, index)};
}

std::uint32_t Document::index(const JsonFields& object, const char* key, const char* list) const {
  const std::uint64_t index = integer(object, key, kMaxCount);
  const std::uint32_t size = count(list);
  if (index >= size) {
    throw InputError(fmt::format("{}: {}[{}] does not exist: there are {}", object.path(key), list,
                                 index, size));
  }
  return static_cast<std::uint32_t>(index);
}

std::optional<std::uint32_t> Document::optionalIndex(const JsonFields& object, const char* key,
                                                     const char* list) const {
  if (!object.has(key)) return {};
  return index(object, key, list);
}

std::vector<std::uint32_t> Document::indices(const JsonFields& object, const char* key,
                                             const char* list) const {
  std::vector<std::uint32_t> found;
  if (!object.has(key)) return found;
  const std::uint32_t size = count(list);
  for (const Json& element : object.array(key)) {
    const auto index = JsonFields::integerOf<std::uint32_t>(element, object.path(key));
    if (index >= size) {
      throw InputError(fmt::format("{}: {}[{}] does not exist: there are {}", object.path(key),
                                   list, index, size));
    }
    found.push_back(index);
  }
  return found;
}

void Document::charge(std::uint64_t count, std::uint64_t bytes_each) {
  constexpr std::uint64_t kBytesPerByte = 200;
  const std::uint64_t limit = spare_bytes_ + kBytesPerByte * bytes_read_;
  const std::uint64_t left = limit - bytes_charged_;
  if (count > left / bytes_each) {
    throw InputError(
        fmt::format("{}: takes more than {} MiB to read: damaged?", name_, limit >> 20));
  }
  bytes_charged_ += count * bytes_each;
}

}  // namespace broadmark::imports::gltf
