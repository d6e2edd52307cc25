// The answers of frames that have been seen, kept so that these frames can be shown again at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "broadmark/harness/case_executor.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/pair.h"

namespace broadmark {

/// Pairs in their order, in about half of their memory.
class PackedPairs {
 public:
  PackedPairs() = default;
  explicit PackedPairs(std::span<const Pair> pairs);

  [[nodiscard]] std::vector<Pair> unpacked() const;
  [[nodiscard]] std::size_t bytes() const { return bytes_.capacity(); }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t count_ = 0;
};

/// An answer for a frame, and its difference from the right one.
struct CachedAnswer {
  std::vector<Pair> pairs;
  bool judged = false;  ///< compared with the oracle's answer, if it can be
  std::optional<FrameDifference> difference;
  std::vector<Pair> right;  ///< the oracle's pairs, unless it agrees()
  Counts counters;          ///< of work

  /// Whether both find the same, allowed extra pairs included.
  [[nodiscard]] bool agrees() const {
    return difference && !difference->isMismatch() && difference->allowed_extra_count == 0;
  }
};

/// The answers of all frames and tracks that fit in a budget; the oldest give way.
class AnswerCache {
 public:
  explicit AnswerCache(std::size_t budget_bytes) : budget_bytes_(budget_bytes) {}

  /// `track`: its number; 0: the oracle. Replaces what was kept before.
  void remember(int track, std::uint32_t frame, const CachedAnswer& answer);
  [[nodiscard]] std::optional<CachedAnswer> recall(int track, std::uint32_t frame) const;
  /// Whether there is one, which was judged if that is asked for.
  [[nodiscard]] bool holds(int track, std::uint32_t frame, bool judged) const;
  void forget(int track);
  void clear();
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  using Key = std::pair<int, std::uint32_t>;
  struct Kept {
    Key key;
    PackedPairs pairs;
    PackedPairs right;
    CachedAnswer rest;  ///< without its pairs
    std::size_t bytes = 0;
  };
  using Entry = std::list<Kept>::iterator;

  void drop(Entry entry);

  std::size_t budget_bytes_;
  std::size_t bytes_ = 0;
  std::list<Kept> kept_;  ///< the oldest first
  std::map<Key, Entry> entries_;
};

}  // namespace broadmark
