// Pairs from many hits, a row at a time: where most boxes overlap, pairs dominate.

/// The hits of a row, at their lanes.
struct RowHits {
  unsigned lanes;
  std::uint32_t body;  ///< the row's
  Keys others;         ///< bodies
};

/// The lanes of a vector at `column` that stand for [begin, end).
inline unsigned lanesIn(std::size_t begin, std::size_t end, std::size_t column) {
  if (begin >= end || end <= column) return 0;
  const unsigned from = begin > column ? ~0U << (begin - column) : ~0U;
  return end - column >= kLanes ? from : from & ((1U << (end - column)) - 1);
}

/// Whether addManyHits() is faster than addHits() for the hits of kRows rows.
inline bool isManyHits(std::uint64_t hits) {
  return static_cast<std::size_t>(__builtin_popcountll(hits)) >= kRows * kLanes / 4;
}

/// As addHits().
template <class Policy>
[[gnu::noinline]] void addManyHits(std::uint64_t hits, std::size_t row, std::size_t column,
                                   std::size_t begin, const Policy& policy, PairBuffer& pairs) {
  Pair* const room = pairs.room(kRows * kLanes + kLanes);
  Pair* end = room;
  for (std::size_t i = row; hits != 0; ++i, hits >>= kLanes) {
    const unsigned lanes = static_cast<unsigned>(hits & ((1U << kLanes) - 1)) &
                           lanesIn(larger(begin, i + 1), policy.endOf(i), column);
    const RowHits found = policy.rowHits(lanes, i, column);
    const Keys body = broadcastKey(found.body);
    const Keys smaller_ids = found.others < body ? found.others : body;
    const Keys larger_ids = found.others < body ? body : found.others;
    end = storePairs(end, found.lanes, smaller_ids, larger_ids);
  }
  pairs.advance(static_cast<std::size_t>(end - room));
}
