// The hash by which recordings, what they are made from, and frames are told apart.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace broadmark {

/// 128 bits that stand for some bytes.
struct HashValue {
  std::uint64_t low = 0;
  std::uint64_t high = 0;

  friend auto operator<=>(const HashValue&, const HashValue&) = default;
};

/// XXH3-128, fed piece by piece.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(Hasher&&) noexcept;
  Hasher& operator=(Hasher&&) noexcept;

  void add(std::span<const std::byte> bytes);
  /// Forgets all bytes.
  void restart();
  /// Of all bytes so far.
  [[nodiscard]] HashValue value() const;
  /// The same as 32 hex digits.
  [[nodiscard]] std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// XXH3-128 of the bytes.
HashValue hashOf(std::span<const std::byte> bytes);

}  // namespace broadmark
