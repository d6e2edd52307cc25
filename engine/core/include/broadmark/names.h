// Names typed by users, and suggestions for misspelt ones.
//
// Example:
//
//   enum class Shape { cube, sphere };
//   constexpr NameTable kShapes{{NamedValue{Shape::cube, "cube"}, {Shape::sphere, "sphere"}}};
//   const std::string_view name = kShapes.nameOf(Shape::cube);
//   if (!kShapes.find("spere")) {
//     const std::string message = unknownName("shape", "spere", kShapes.names());
//   }
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark {

/// An entry of a NameTable. The name is borrowed, usually from a string literal.
template <class Value>
struct NamedValue {
  Value value;
  std::string_view name;
};
template <class Value>  // clang before 17 needs the guide spelled out
NamedValue(Value, std::string_view) -> NamedValue<Value>;

/// Values with their names, for lookup in both directions: O(size).
template <class Value, std::size_t size>
struct NameTable {
  std::array<NamedValue<Value>, size> entries;

  /// The name of a value; "?" if it is not in the table.
  [[nodiscard]] constexpr std::string_view nameOf(Value value) const {
    for (const auto& entry : entries) {
      if (entry.value == value) return entry.name;
    }
    return "?";
  }
  /// The value with exactly this name.
  [[nodiscard]] constexpr std::optional<Value> find(std::string_view name) const {
    for (const auto& entry : entries) {
      if (entry.name == name) return entry.value;
    }
    return std::nullopt;
  }
  /// All names, in the order of the table.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : entries) names.emplace_back(entry.name);
    return names;
  }
};
template <class Value, std::size_t size>
NameTable(const NamedValue<Value> (&)[size]) -> NameTable<Value, size>;

/// A value for each of `size` keys: the values of an enum, which are numbered from 0. Keys are not
/// checked.
template <class Key, class Value, std::size_t size>
struct ValueOfEach {
  std::array<Value, size> values{};

  constexpr Value& operator[](Key key) { return values[static_cast<std::size_t>(key)]; }
  constexpr const Value& operator[](Key key) const { return values[static_cast<std::size_t>(key)]; }
};

/// The known name with the smallest edit distance to `name`, ignoring case; the first of several.
/// "" when none is within half the length of `name`, or two letters if that is more, and for names
/// of more than 64 characters.
std::string nearestName(std::string_view name, std::span<const std::string> known);

/// «unknown KIND 'NAME'; did you mean 'NEAREST'? (one of: …)», without the question if no known
/// name is near. A message: the caller throws it.
std::string unknownName(std::string_view kind, std::string_view name,
                        std::span<const std::string> known);

/// Shell-style match of a whole word: *, ?, sets as in [a-d], and \ before a character that stands
/// for itself. Case matters.
bool globMatches(std::string_view glob, std::string_view word);

/// The whole text as a decimal integer in [min, max], without spaces or a plus sign. Throws
/// InputError naming `what` otherwise.
long long parseInteger(std::string_view text, std::string_view what, long long min, long long max);

}  // namespace broadmark
