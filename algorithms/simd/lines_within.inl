// linesWithin() for all instruction sets but AVX-512.

/// Compares the values of eight cache lines with limits, one per line. In byte l of the result,
/// bits 0 to 4 are valuesWithin() of line l, and bit 7 is set if the top bit of its last value is
/// clear; the other bits are zero or unspecified. The top byte of each limit is 0.
inline std::uint64_t linesWithin(const std::uint64_t* const* lines, const std::uint64_t* limits) {
  std::uint64_t within = 0;
  for (int l = 0; l < 8; ++l) {
    const std::uint64_t top_is_clear = ~lines[l][7] >> 63;
    within |= ((valuesWithin(lines[l], limits[l]) & 0x1F) | top_is_clear << 7) << 8 * l;
  }
  return within;
}
