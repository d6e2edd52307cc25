#include "broadmark/recordings/ordered_frames.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

#include "recording_file.h"

namespace broadmark {
namespace {

/// Fisher-Yates, because std::shuffle differs between standard libraries.
void shuffle(std::vector<std::uint32_t>& ids) {
  std::mt19937_64 random;
  for (std::size_t left = ids.size(); left > 1; --left) {
    std::swap(ids[left - 1], ids[random() % left]);
  }
}

/// The bits of a number of 21 bits, two zeros after each.
std::uint64_t spreadBits(std::uint64_t number) {
  std::uint64_t spread = 0;
  for (int bit = 0; bit < 21; ++bit) spread |= (number >> bit & 1) << 3 * bit;
  return spread;
}

void sortAlongMortonCurve(std::vector<std::uint32_t>& ids, std::span<const Aabb> boxes) {
  constexpr double kMaxCell = (1 << 21) - 1;
  constexpr std::uint64_t kAbsent = std::numeric_limits<std::uint64_t>::max();
  std::vector<std::uint64_t> codes(boxes.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Aabb& box : boxes) {
      if (isEmpty(box)) continue;
      low = std::min(low, centreOf(box, axis));
      high = std::max(high, centreOf(box, axis));
    }
    const double scale = high > low ? kMaxCell / (high - low) : 0;
    for (std::size_t body = 0; body < boxes.size(); ++body) {
      if (isEmpty(boxes[body])) {
        codes[body] = kAbsent;
      } else {
        const double cell = (centreOf(boxes[body], axis) - low) * scale;
        codes[body] |= spreadBits(static_cast<std::uint64_t>(cell)) << axis;
      }
    }
  }
  std::ranges::stable_sort(ids, {}, [&](std::uint32_t body) { return codes[body]; });
}

}  // namespace

SceneInfo orderedScene(SceneInfo scene) {
  scene.name = suffixedName(scene, kOrderedSuffix);
  return scene;
}

OrderedFrames::OrderedFrames(std::unique_ptr<IndexedFrames> frames, BodyOrder order)
    : AdaptedFrames(std::move(frames)), source_ids_(scene_.objects), new_ids_(scene_.objects) {
  std::iota(source_ids_.begin(), source_ids_.end(), 0U);
  if (order == BodyOrder::random) {
    shuffle(source_ids_);
  } else {
    sortAlongMortonCurve(source_ids_, readSource(0).boxes);
  }
  for (std::uint32_t id = 0; id < source_ids_.size(); ++id) new_ids_[source_ids_[id]] = id;
  scene_ = orderedScene(std::move(scene_));
  scene_.filter = scene_.filter.of(source_ids_);
}

std::span<const Aabb> OrderedFrames::readBoxes(std::uint32_t index) {
  const std::optional<std::uint32_t> last = std::exchange(last_, {});  // in case reading fails
  const Frame frame = readSource(index);
  if (reports_changes_) rename(*frame.changed, changed_);
  if (reports_changes_ && index > 0 && last == index - 1) {
    for (const std::uint32_t id : changed_) boxes_[id] = frame.boxes[source_ids_[id]];
  } else {
    for (std::uint32_t id = 0; id < boxes_.size(); ++id) boxes_[id] = frame.boxes[source_ids_[id]];
  }
  if (frame.filter != nullptr) {
    ordered_filter_ = frame.filter->of(source_ids_);
    rename(frame.filter_changed, ordered_filter_changes_);
    filter_ = &ordered_filter_;
    filter_changed_ = ordered_filter_changes_;
  }
  last_ = index;
  return boxes_;
}

void OrderedFrames::rename(std::span<const std::uint32_t> bodies,
                           std::vector<std::uint32_t>& ids) const {
  ids.clear();
  for (const std::uint32_t body : bodies) ids.push_back(new_ids_[body]);
  std::ranges::sort(ids);
}

}  // namespace broadmark
