// Parts of recordings.

#include "broadmark/sub_recording.h"

#include <numeric>
#include <string_view>

#include "broadmark/recording.h"

namespace broadmark {

Part wholePart(const SceneInfo& scene, std::uint32_t last_frame) {
  Part all;
  all.bodies.resize(scene.objects);
  all.frames.resize(std::size_t{last_frame} + 1);
  std::iota(all.bodies.begin(), all.bodies.end(), 0U);
  std::iota(all.frames.begin(), all.frames.end(), 0U);
  return all;
}

SubRecording::SubRecording(IndexedFrames& whole, Part part, std::string name)
    : whole_(whole), part_(std::move(part)), scene_(whole.scene()) {
  scene_.name = std::move(name);
  scene_.objects = static_cast<std::uint32_t>(part_.bodies.size());
  scene_.frames = static_cast<std::uint32_t>(part_.frames.size() - 1);
  scene_.filter = whole.scene().filter.of(part_.bodies);
  boxes_.resize(scene_.objects);
}

std::span<const Aabb> SubRecording::readBoxes(std::uint32_t index) {
  const Frame frame = whole_.at(part_.frames[index]);
  for (std::size_t i = 0; i < boxes_.size(); ++i) boxes_[i] = frame.boxes[part_.bodies[i]];
  return boxes_;
}

std::string partName(const SceneInfo& scene) {
  constexpr std::string_view kSuffix = " case";
  if (scene.name.ends_with(kSuffix)) return scene.name;
  return scene.name.substr(0, kLongestName - kSuffix.size()).append(kSuffix);
}

std::string writePart(const std::filesystem::path& path, IndexedFrames& whole, const Part& part) {
  SubRecording frames(whole, part, partName(whole.scene()));
  RecordingWriter writer(path, frames.scene());
  recordAll(frames, writer);
  return writer.finish();
}

}  // namespace broadmark
