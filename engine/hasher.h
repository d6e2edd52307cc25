// The hash by which recordings, and what they are made from, are told apart.
#pragma once

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstddef>
#include <span>
#include <string>

namespace broadmark {

/// XXH3-128.
class Hasher {
 public:
  Hasher() { XXH3_128bits_reset(&state_); }
  void add(std::span<const std::byte> bytes) {
    XXH3_128bits_update(&state_, bytes.data(), bytes.size());
  }
  [[nodiscard]] std::string hex() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(&state_);
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  XXH3_state_t state_{};
};

}  // namespace broadmark
