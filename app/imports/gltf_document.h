// The parts of a glTF 2.0 file: JSON objects, buffers, accessors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/json_fields.h"
#include "imports/import_summary.h"

namespace broadmark::imports::gltf {

/// Limits of counts and of byte offsets: sums of these do not overflow.
inline constexpr std::uint64_t kMaxCount = std::numeric_limits<std::uint32_t>::max();
inline constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 62;

/// Reads a whole file. Throws InputError.
std::string readBytes(const std::filesystem::path& path);

/// Throws InputError about a JSON object of the file.
[[noreturn]] void fail(const JsonFields& object, std::string_view what);

/// An integer from 0 to `max`; also if it is written as 3.0.
std::uint64_t integer(const JsonFields& object, const char* key, std::uint64_t max);
/// Same for an optional field.
std::uint64_t integerOr(const JsonFields& object, const char* key, std::uint64_t fallback,
                        std::uint64_t max);
/// An array of finite numbers.
std::vector<double> numbers(const JsonFields& object, const char* key);
/// An optional text; "" if it is missing.
std::string textOr(const JsonFields& object, const char* key);
/// An extension of an object, if it has that.
std::optional<JsonFields> extension(const JsonFields& object, const char* name);

/// Elements of one type: numbers, vectors or matrices. All indices are within their buffers.
class Accessor {
 public:
  std::uint32_t count = 0;
  std::string name;  ///< for messages

  /// Reads the components of an element; integers are converted as the accessor states.
  void read(std::uint32_t element, std::span<double> components) const;
  [[nodiscard]] double number(std::uint32_t element) const;

 private:
  friend class Document;

  [[nodiscard]] double component(const std::byte* bytes) const;

  int component_type_ = 0;
  bool is_normalized_ = false;
  std::uint32_t component_size_ = 0;
  std::uint32_t element_size_ = 0;
  std::string type_;
  const std::byte* elements_ = nullptr;  ///< null: all are 0
  std::uint64_t stride_ = 0;
  std::vector<std::uint32_t> sparse_indices_;  ///< ascending: elements that are stored apart
  const std::byte* sparse_values_ = nullptr;
};

/// A file with its buffers, which are read when they are needed. Checks what it returns; every
/// method throws InputError, with the name of the JSON object.
class Document {
 public:
  /// `spare_bytes`: memory that a file may take beyond what its size explains.
  Document(const std::filesystem::path& file, std::uint64_t spare_bytes, ImportSummary& summary);

  [[nodiscard]] const JsonFields& root() const { return *root_; }
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Size of one of the outermost arrays: "nodes".
  [[nodiscard]] std::uint32_t count(const char* list) const;
  /// An element of such an array.
  [[nodiscard]] JsonFields item(const char* list, std::uint32_t index) const;
  /// An index into such an array.
  [[nodiscard]] std::uint32_t index(const JsonFields& object, const char* key,
                                    const char* list) const;
  [[nodiscard]] std::optional<std::uint32_t> optionalIndex(const JsonFields& object,
                                                           const char* key, const char* list) const;
  /// An array of such indices; empty if it is missing.
  [[nodiscard]] std::vector<std::uint32_t> indices(const JsonFields& object, const char* key,
                                                   const char* list) const;

  /// The accessor that `object` names, of this type: "VEC3".
  const Accessor& accessor(const JsonFields& object, const char* key, std::string_view type);
  /// Same for vertex indices: integers.
  const Accessor& vertexIndices(const JsonFields& object, const char* key);

  /// Counts memory that is about to be used, against the limit: a file of a few bytes may claim
  /// any number of elements.
  void charge(std::uint64_t count, std::uint64_t bytes_each);

 private:
  void readBinary(std::string_view bytes, ImportSummary& summary);
  void requireVersion() const;
  void requireExtensions(ImportSummary& summary) const;

  Accessor parseAccessor(const JsonFields& object);
  void readSparse(const JsonFields& sparse, Accessor& accessor);
  /// Bytes of a buffer view, from an offset in it on; sets `stride` if the view has one.
  std::string_view bytesOf(const JsonFields& object, std::uint64_t* stride = nullptr);
  std::string_view buffer(std::uint32_t index);
  std::string readBuffer(const JsonFields& object, const std::string& uri, std::uint64_t size);

  std::filesystem::path path_;
  std::string name_;
  std::string file_;  ///< its bytes
  Json json_;
  std::optional<JsonFields> root_;
  std::optional<std::string_view> binary_chunk_;
  std::map<std::uint32_t, std::string> buffers_;
  std::map<std::uint32_t, Accessor> accessors_;
  std::uint64_t bytes_read_ = 0;
  std::uint64_t bytes_charged_ = 0;
  std::uint64_t spare_bytes_;
};

}  // namespace broadmark::imports::gltf
