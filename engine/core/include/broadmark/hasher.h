// The hash that identifies recordings, their sources, and frames.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace broadmark {

struct HashValue {
  std::uint64_t low = 0;
  std::uint64_t high = 0;

  friend auto operator<=>(const HashValue&, const HashValue&) = default;
};

/// XXH3-128, incremental.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(Hasher&&) noexcept;
  Hasher& operator=(Hasher&&) noexcept;

  void add(std::span<const std::byte> bytes);
  void restart();
  /// The hash of all bytes so far.
  [[nodiscard]] HashValue value() const;
  /// The same as 32 hex digits.
  [[nodiscard]] std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

HashValue hashOf(std::span<const std::byte> bytes);

}  // namespace broadmark
