// The kernel of Tide, written once; compiled for each instruction set by for_each_isa.inl.
//
// In few lines there is somebody who is wanted, and nobody could predict in which, so nothing
// branches: all looks are written down, and counted only if they found something.

tide::Kernels::Found look(const tide::Line* const* lines, const tide::Bounds* least,
                          std::size_t count, std::uint32_t first, tide::Hit* hits,
                          std::uint32_t* followed) {
  constexpr std::uint32_t kPlaces = (1U << tide::Line::kPlaces) - 1;
  tide::Kernels::Found found = {0, 0};
  for (std::size_t i = 0; i < count; ++i) {
    const tide::Line* const line = lines[i];
    const auto look = first + static_cast<std::uint32_t>(i);
    const std::uint32_t places = lowBytesReach(line->bounds, least[i]) & kPlaces;
    hits[found.hits] = {line, look, places};
    found.hits += places != 0 ? 1 : 0;
    followed[found.followed] = look;
    found.followed += line->next != tide::kNowhere ? 1 : 0;
  }
  return found;
}

inline constexpr tide::Kernels kKernels = {look};
