// Parts of recordings.

#include "broadmark/recordings/sub_recording.h"

#include <algorithm>
#include <numeric>
#include <string_view>

#include "broadmark/recordings/recording.h"
#include "recording_file.h"

namespace broadmark {

Selection selectionOf(const SceneInfo& scene, std::vector<std::uint32_t> bodies,
                      std::vector<std::uint32_t> frames) {
  CollisionFilter filter = scene.filter.of(bodies);
  std::vector<std::uint32_t> filter_changes;
  if (scene.filter_changes) filter_changes = bodies;
  return {.bodies = std::move(bodies),
          .frames = std::move(frames),
          .all_present = scene.all_present,
          .filter = std::move(filter),
          .filter_changes = std::move(filter_changes)};
}

Selection selectAll(const SceneInfo& scene, std::uint32_t last_frame) {
  std::vector<std::uint32_t> bodies(scene.objects);
  std::vector<std::uint32_t> frames(std::size_t{last_frame} + 1);
  std::iota(bodies.begin(), bodies.end(), 0U);
  std::iota(frames.begin(), frames.end(), 0U);
  return selectionOf(scene, std::move(bodies), std::move(frames));
}

SubRecording::SubRecording(IndexedFrames& whole, Selection part, std::string name)
    : whole_(whole), part_(std::move(part)), scene_(whole.scene()) {
  scene_.name = std::move(name);
  scene_.objects = static_cast<std::uint32_t>(part_.bodies.size());
  scene_.frames = static_cast<std::uint32_t>(part_.frames.size() - 1);
  scene_.all_present = part_.all_present;
  scene_.filter = part_.filter;
  scene_.filter_changes = whole.scene().filter_changes && !part_.filter_changes.empty();
  if (scene_.filter_changes) scene_.filter = filterFrom(whole_.at(part_.frames.front()));
  boxes_.resize(scene_.objects);
}

CollisionFilter SubRecording::filterFrom(const Frame& frame) const {
  const CollisionFilter& filter = frame.filterIn(whole_.scene());
  std::vector<std::uint32_t> changed;
  std::vector<BodyGroups> groups;
  for (std::uint32_t i = 0; i < part_.bodies.size(); ++i) {
    if (!std::ranges::binary_search(part_.filter_changes, part_.bodies[i])) continue;
    changed.push_back(i);
    groups.push_back(filter.groupsOf(part_.bodies[i]));
  }
  return part_.filter.with(changed, groups, part_.bodies.size());
}

std::span<const Aabb> SubRecording::readBoxes(std::uint32_t index) {
  const std::uint32_t number = part_.frames[index];
  const Frame frame = whole_.at(number);
  if (scene_.filter_changes && (whole_filter_ != frame.filterIn(whole_.scene()) || !has_filter_)) {
    whole_filter_ = frame.filterIn(whole_.scene());
    filter_ = filterFrom(frame);
    has_filter_ = true;
  }
  for (std::size_t i = 0; i < boxes_.size(); ++i) boxes_[i] = frame.boxes[part_.bodies[i]];
  for (const Filling& filling : part_.filled) {
    if (number < filling.first || number > filling.last) continue;
    const auto body = std::ranges::lower_bound(part_.bodies, filling.body);
    if (body == part_.bodies.end() || *body != filling.body) continue;
    boxes_[static_cast<std::size_t>(body - part_.bodies.begin())] = filling.box;
  }
  return boxes_;
}

std::string partName(const SceneInfo& scene) {
  constexpr std::string_view kSuffix = " case";
  if (scene.name.ends_with(kSuffix)) return scene.name;
  return suffixedName(scene, kSuffix);
}

std::string writeSelection(const std::filesystem::path& path, IndexedFrames& whole,
                           const Selection& part) {
  SubRecording frames(whole, part, partName(whole.scene()));
  RecordingWriter writer(path, frames.scene());
  recordAll(frames, writer);
  return writer.finish();
}

}  // namespace broadmark
