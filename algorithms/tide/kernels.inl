// Nobody can tell which entries are hits: so there is no branch.
std::size_t findHits(const tide::Run* begin, const tide::Run* end, const Aabb& box,
                     std::uint32_t moving, const tide::Entry** hits) {
  const TestBox against = testBox(reinterpret_cast<const float*>(&box));
  std::size_t count = 0;
  for (const tide::Run* run = begin; run != end; ++run) {
    const tide::Entry* const last = run->entries + run->count;
    for (const tide::Entry* entry = run->entries; entry != last; ++entry) {
      std::uint32_t move;
      __builtin_memcpy(&move, reinterpret_cast<const float*>(entry) + 7, sizeof move);
      hits[count] = entry;
      count += meets(reinterpret_cast<const float*>(entry), against) | unsigned{move >= moving};
    }
  }
  return count;
}

inline constexpr tide::Kernels kKernels = {findHits};
