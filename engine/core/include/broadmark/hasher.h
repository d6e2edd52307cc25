// The hash that identifies recordings, their sources, and frames.
//
// Example:
//
//   const std::string text = "all bytes of a file, in parts";
//   Hasher hasher;
//   hasher.add(std::as_bytes(std::span(text).first(9)));
//   hasher.add(std::as_bytes(std::span(text).subspan(9)));
//   const std::string name = hasher.hex();
//   const bool equal = hasher.value() == hashOf(std::as_bytes(std::span(text)));  // true
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace broadmark {

/// 128 bits. Not cryptographic: detects damage, not forgery.
struct HashValue {
  std::uint64_t low = 0;
  std::uint64_t high = 0;

  friend auto operator<=>(const HashValue&, const HashValue&) = default;
};

/// XXH3-128, incremental: depends on the bytes, not on their division into parts. One moved from
/// may only be destroyed or assigned to.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(Hasher&&) noexcept;
  Hasher& operator=(Hasher&&) noexcept;

  void add(std::span<const std::byte> bytes);
  /// Forgets all bytes added so far.
  void restart();
  /// The hash of all bytes so far. More may be added afterwards.
  [[nodiscard]] HashValue value() const;
  /// The same as 32 lower-case hex digits, `high` first.
  [[nodiscard]] std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The hash of these bytes. O(n); allocates nothing.
HashValue hashOf(std::span<const std::byte> bytes);

}  // namespace broadmark
