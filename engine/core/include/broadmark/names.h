// Names typed by users, and suggestions for misspelt ones.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace broadmark {

template <class Value>
struct NamedValue {
  Value value;
  std::string_view name;
};
template <class Value>  // clang before 17 needs the guide spelled out
NamedValue(Value, std::string_view) -> NamedValue<Value>;

/// Values with their names, for lookup in both directions.
template <class Value, std::size_t size>
struct NameTable {
  std::array<NamedValue<Value>, size> entries;

  /// Requires `value` to be in the table.
  [[nodiscard]] constexpr std::string_view nameOf(Value value) const {
    for (const auto& entry : entries) {
      if (entry.value == value) return entry.name;
    }
    return "?";
  }
  [[nodiscard]] constexpr std::optional<Value> find(std::string_view name) const {
    for (const auto& entry : entries) {
      if (entry.name == name) return entry.value;
    }
    return std::nullopt;
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : entries) names.emplace_back(entry.name);
    return names;
  }
};
template <class Value, std::size_t size>
NameTable(const NamedValue<Value> (&)[size]) -> NameTable<Value, size>;

/// A value for each of `size` keys, which are numbered from 0.
template <class Key, class Value, std::size_t size>
struct ValueOfEach {
  std::array<Value, size> values{};

  constexpr Value& operator[](Key key) { return values[static_cast<std::size_t>(key)]; }
  constexpr const Value& operator[](Key key) const { return values[static_cast<std::size_t>(key)]; }
};

/// The known name with the smallest edit distance to `name`, or "" when none is close.
std::string nearestName(std::string_view name, std::span<const std::string> known);

/// «unknown KIND 'NAME'; did you mean 'NEAREST'? (one of: …)»
std::string unknownName(std::string_view kind, std::string_view name,
                        std::span<const std::string> known);

/// Shell-style match of a whole word: * and ?.
bool globMatches(std::string_view glob, std::string_view word);

/// The text as an integer in [min, max]. Throws InputError naming `what` otherwise.
long long parseInteger(std::string_view text, std::string_view what, long long min, long long max);

}  // namespace broadmark
