// A pyramid: each block combines two blocks of the level below. A query of a range of frames visits
// the largest blocks inside the range.

#include "broadmark/render/frame_values.h"

#include <algorithm>
#include <bit>

namespace broadmark {
namespace {

FrameValues::Range united(FrameValues::Range a, FrameValues::Range b) {
  return {std::fmin(a.low, b.low), std::fmax(a.high, b.high)};
}

/// Calls visit(level, index) for the largest blocks that partition the frames from `first` to
/// `last`, in order, until a call returns true.
template <class Visit>
void visitBlocks(std::uint64_t first, std::uint64_t last, Visit&& visit) {
  while (first <= last) {
    const auto aligned = static_cast<unsigned>(first == 0 ? 63 : std::countr_zero(first));
    const auto fitting = static_cast<unsigned>(std::bit_width(last - first + 1)) - 1;
    const unsigned level = std::min(aligned, fitting);
    if (visit(level, static_cast<std::uint32_t>(first >> level))) return;
    first += std::uint64_t{1} << level;
  }
}

}  // namespace

void FrameValues::set(std::uint32_t frame, float value) {
  if (frame >= values_.size()) values_.resize(frame + 1, kUnknown);
  values_[frame] = value;
  for (unsigned level = 1; (values_.size() - 1) >> (level - 1) > 0; ++level) {
    const bool is_new = levels_.size() < level;
    if (is_new) levels_.emplace_back();
    std::vector<Range>& blocks = levels_[level - 1];
    const std::uint32_t index = frame >> level;
    if (blocks.size() <= index) blocks.resize(index + 1);
    const auto unite = [&](std::uint32_t which) {
      blocks[which] = united(block(level - 1, 2 * which), block(level - 1, 2 * which + 1));
    };
    unite(index);
    if (is_new) unite(0);  // from the values set before
  }
}

FrameValues::Range FrameValues::block(unsigned level, std::uint32_t index) const {
  if (level == 0) return {at(index), at(index)};
  if (level > levels_.size()) {
    // A block larger than the whole pyramid.
    if (index > 0 || values_.empty()) return {};
    return levels_.empty() ? block(0, 0) : levels_.back().front();
  }
  const std::vector<Range>& blocks = levels_[level - 1];
  return index < blocks.size() ? blocks[index] : Range{};
}

FrameValues::Range FrameValues::within(std::uint32_t first, std::uint32_t last) const {
  Range range;
  visitBlocks(first, last, [&](unsigned level, std::uint32_t index) {
    range = united(range, block(level, index));
    return false;
  });
  return range;
}

template <class Predicate>
std::optional<std::uint32_t> FrameValues::firstWhere(std::uint32_t first, std::uint32_t last,
                                                     const Predicate& contains) const {
  std::optional<std::uint32_t> found;
  visitBlocks(first, last, [&](unsigned level, std::uint32_t index) {
    if (!contains(block(level, index))) return false;
    for (; level > 0; --level) index = 2 * index + (contains(block(level - 1, 2 * index)) ? 0 : 1);
    found = index;
    return true;
  });
  return found;
}

std::optional<std::uint32_t> FrameValues::highest(std::uint32_t first, std::uint32_t last) const {
  const float high = within(first, last).high;
  return firstWhere(first, last, [&](Range range) { return range.high == high; });
}

std::optional<std::uint32_t> FrameValues::firstKnown(std::uint32_t first,
                                                     std::uint32_t last) const {
  return firstWhere(first, last, [](Range range) { return range.known(); });
}

}  // namespace broadmark
