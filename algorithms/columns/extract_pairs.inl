// Pairs from hits, one hit at a time. Branchless, as the outcome of a test is unpredictable.

std::size_t extractPairs(std::uint64_t* positions, std::uint64_t* masks, std::size_t count,
                         const columns::CellEntry* entries, Pair*& pairs, Pair*& ambiguous) {
  Pair* pairs_end = pairs;
  Pair* ambiguous_end = ambiguous;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint64_t position = positions[k];
    const std::uint64_t mask = masks[k];
    const std::uint64_t rest = mask & (mask - 1);
    positions[kept] = position;
    masks[kept] = rest;
    kept += rest != 0 ? 1 : 0;

    const auto bit = static_cast<std::size_t>(__builtin_ctzll(mask));
    const std::size_t i = (position & 0xFFFF'FFFF) + laneOf(bit);
    const std::size_t j = i + (position >> 32) + offsetOf(bit);
    const EntryComparison compared = compareEntries(&entries[i].sweep_min, &entries[j].sweep_min);
    const CellBody a = entries[i].body;
    const CellBody b = entries[j].body;
    const unsigned found = compared.overlap & unsigned{isHomeCellPair(a, b)};
    const Pair pair = orderedPair(bodyId(a), bodyId(b));
    *pairs_end = pair;
    pairs_end += found & ~compared.ambiguous;
    *ambiguous_end = pair;
    ambiguous_end += found & compared.ambiguous;
  }
  pairs = pairs_end;
  ambiguous = ambiguous_end;
  return kept;
}
