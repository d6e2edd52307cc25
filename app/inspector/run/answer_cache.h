// Cached answers of frames already run, so that these frames can be shown again at once.
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

/// Pairs in their order, delta-encoded in about half of the memory.
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

/// An answer for a frame, and its difference from the oracle's.
struct CachedAnswer {
  std::vector<Pair> pairs;
  bool checked = false;  ///< compared with the oracle's answer, if the algorithm can be checked
  std::optional<FrameDifference> difference;
  std::vector<Pair> oracle_pairs;  ///< empty if matchesOracle()
  Counts counters;                 ///< work counters

  /// Whether the pairs are exactly the oracle's, without allowed extra pairs.
  [[nodiscard]] bool matchesOracle() const {
    return difference && !difference->isMismatch() && difference->allowed_extra_count == 0;
  }
};

/// The answers of frames and tracks, within a memory budget; the oldest are evicted first.
class AnswerCache {
 public:
  explicit AnswerCache(std::size_t budget_bytes) : budget_bytes_(budget_bytes) {}

  /// Stores an answer, replacing an earlier one. `track`: number of the track; 0: the oracle.
  void insert(int track, std::uint32_t frame, const CachedAnswer& answer);
  [[nodiscard]] std::optional<CachedAnswer> find(int track, std::uint32_t frame) const;
  /// Whether there is an answer; with `checked`, one that was compared with the oracle's.
  [[nodiscard]] bool contains(int track, std::uint32_t frame, bool checked) const;
  void erase(int track);
  void clear();
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  using Key = std::pair<int, std::uint32_t>;
  struct Entry {
    Key key;
    PackedPairs pairs;
    PackedPairs oracle_pairs;
    CachedAnswer metadata;  ///< the answer without its pairs
    std::size_t bytes = 0;
  };
  using Iterator = std::list<Entry>::iterator;

  void evict(Iterator entry);

  std::size_t budget_bytes_;
  std::size_t bytes_ = 0;
  std::list<Entry> entries_;  ///< oldest first
  std::map<Key, Iterator> index_;
};

}  // namespace broadmark
