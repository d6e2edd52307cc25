#include "run/wrong_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace broadmark {
namespace {

std::string cornerText(const std::array<float, 4>& corner) {
  return fmt::format("({}, {}, {})", corner[0], corner[1], corner[2]);
}

}  // namespace

std::string wrongPairsText(const FrameDifference& difference) {
  constexpr std::size_t kMaxPairs = 100;
  std::string text;
  const auto add = [&](const char* kind, std::uint64_t count, const std::vector<Pair>& pairs) {
    if (count == 0) return;
    text += fmt::format("{}{}", text.empty() ? "" : "; ", kind);
    const std::size_t shown = std::min(pairs.size(), kMaxPairs);
    for (std::size_t i = 0; i < shown; ++i) {
      text += fmt::format("{} {}-{}", i == 0 ? "" : ",", pairs[i].a, pairs[i].b);
    }
    if (count > shown) text += fmt::format(" and {} more", count - shown);
  };
  add("missed", difference.missed_count, difference.missed_pairs);
  add("false", difference.false_count, difference.false_pairs);
  add("invalid", difference.invalid_count, difference.invalid_pairs);
  return text;
}

std::string smallPartText(IndexedFrames& whole, const Selection& part) {
  constexpr std::size_t kMaxShownBodies = 4;
  if (part.bodies.size() > kMaxShownBodies) return {};
  SubRecording small(whole, part, partName(whole.scene()));
  std::string text;
  const std::uint32_t last = small.scene().frames;
  for (std::uint32_t frame = last == 0 ? 0 : last - 1; frame <= last; ++frame) {
    const std::span<const Aabb> boxes = small.at(frame).boxes;
    for (std::size_t body = 0; body < boxes.size(); ++body) {
      const Aabb& box = boxes[body];
      text += fmt::format("  frame {}, body {}: {}\n", frame, body,
                          isEmpty(box) ? std::string("absent")
                                       : cornerText(box.min) + " to " + cornerText(box.max));
    }
  }
  return text;
}

}  // namespace broadmark
