// Pairs from hits, one hit after the other.

std::size_t takePairs(std::uint64_t* places, std::uint64_t* bits, std::size_t count,
                      const columns::Copy* copies, Pair*& pairs, Pair*& doubtful) {
  // Conditions are numbers here, as nobody can tell how they turn out.
  Pair* sure_end = pairs;
  Pair* doubtful_end = doubtful;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint64_t place = places[k];
    const std::uint64_t of_hit = bits[k];
    const std::uint64_t more = of_hit & (of_hit - 1);
    places[kept] = place;
    bits[kept] = more;
    kept += more != 0 ? 1 : 0;

    const auto bit = static_cast<std::size_t>(__builtin_ctzll(of_hit));
    const std::size_t i = (place & 0xFFFF'FFFF) + laneOf(bit);
    const std::size_t j = i + (place >> 32) + stepOf(bit);
    const ComparedCopies steps = compareCopies(&copies[i].first, &copies[j].first);
    const MarkedBody a = copies[i].body;
    const MarkedBody b = copies[j].body;
    const unsigned found = steps.overlap & unsigned{reportedHere(a, b)};
    const Pair pair = orderedPair(bodyNumber(a), bodyNumber(b));
    *sure_end = pair;
    sure_end += found & ~steps.shared;
    *doubtful_end = pair;
    doubtful_end += found & steps.shared;
  }
  pairs = sure_end;
  doubtful = doubtful_end;
  return kept;
}
