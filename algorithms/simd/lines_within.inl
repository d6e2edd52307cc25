// Lines one by one, for all but AVX-512.

/// Eight cache lines of eight numbers, and limits for the numbers of each: in byte l of the result,
/// bits 0 to 4 are numbersWithin() line l, and bit 7 is set if the highest bit of its last number
/// is 0; the others are not set or mean nothing. The highest byte of limits is 0.
inline std::uint64_t linesWithin(const std::uint64_t* const* lines, const std::uint64_t* limits) {
  std::uint64_t within = 0;
  for (int l = 0; l < 8; ++l) {
    const std::uint64_t last_is_low = ~lines[l][7] >> 63;
    within |= ((numbersWithin(lines[l], limits[l]) & 0x1F) | last_is_low << 7) << 8 * l;
  }
  return within;
}
