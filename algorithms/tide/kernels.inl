// The kernel of Tide, written once; compiled for each instruction set by for_each_isa.inl.
//
// Nobody could predict which looks find somebody, so nothing branches: all of them are written
// down, and counted only if they do.

tide::Kernels::Found look(const tide::Look* looks, std::size_t count, std::uint32_t first,
                          tide::Hit* hits, tide::Hit* followed) {
  tide::Kernels::Found found = {0, 0, 0};
  for (std::size_t i = 0; i < count; ++i) {
    const tide::Look& look = looks[i];
    const auto* const lines = reinterpret_cast<const std::uint64_t* const*>(look.lines);
    const std::uint64_t within = linesWithin(lines, look.limits) & look.wanted;
    constexpr std::uint64_t kEach = 0x0101'0101'0101'0101;
    found.lines += (look.wanted & kEach) * kEach >> 56;
    const std::uint64_t places = within & tide::Look::kPlaces;
    const std::uint64_t are_followed = within & tide::Look::kFollowed;
    const auto number = first + static_cast<std::uint32_t>(i);
    hits[found.hits] = {places, number};
    found.hits += places != 0 ? 1 : 0;
    followed[found.followed] = {are_followed, number};
    found.followed += are_followed != 0 ? 1 : 0;
  }
  return found;
}

inline constexpr tide::Kernels kKernels = {look};
