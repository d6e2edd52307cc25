#include "inspector/run/frame_provider.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/recordings/swept_frames.h"
#include "broadmark/scenes/authored_simulation.h"

namespace broadmark {
namespace {

constexpr const char* kKeptName = "the frames simulated so far";

/// A file of boxes, frame after frame and nothing else. Those that are not written yet cannot be
/// read.
class KeptFrames final : public IndexedFrames {
 public:
  KeptFrames(SceneInfo scene, std::shared_ptr<const FileDescriptor> file)
      : scene_(std::move(scene)), file_(std::move(file)), boxes_(scene_.objects) {}

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    const auto bytes = std::as_writable_bytes(std::span(boxes_));
    if (readAll(file_->get(), bytes, std::uint64_t{index} * bytes.size()) < bytes.size()) {
      throw InputError(fmt::format("{}: cannot read frame {}", kKeptName, index));
    }
    return boxes_;
  }

  SceneInfo scene_;
  std::shared_ptr<const FileDescriptor> file_;
  std::vector<Aabb> boxes_;
};

void append(const FileDescriptor& file, std::span<const Aabb> boxes) {
  writeAll(file.get(), std::as_bytes(boxes), kKeptName);
}

/// The frames as they are shown, swept or not.
std::unique_ptr<IndexedFrames> shown(std::unique_ptr<IndexedFrames> frames, bool swept) {
  if (!swept) return frames;
  return std::make_unique<SweptFrames>(std::move(frames));
}

}  // namespace

FrameProvider::FrameProvider(std::unique_ptr<Recording> recording, bool swept)
    : swept_(swept),
      known_(recording->scene().frames),
      frames_(shown(std::move(recording), swept)) {}

FrameProvider::FrameProvider(std::unique_ptr<FrameSource> simulation, bool swept)
    : swept_(swept), simulation_(std::move(simulation)) {
  const Frame first = simulation_->rewind();
  keep(simulation_->scene(), first.boxes);
}

FrameProvider::FrameProvider(SceneInfo scene, std::span<const Aabb> boxes) { keep(scene, boxes); }

void FrameProvider::keep(const SceneInfo& scene, std::span<const Aabb> first) {
  kept_ = std::make_shared<const FileDescriptor>(unnamedFile());
  frames_ = shown(std::make_unique<KeptFrames>(scene, kept_), swept_);
  append(*kept_, first);
}

void FrameProvider::extend() {
  const std::optional<Frame> frame = simulation_->next();
  if (!frame) throw std::logic_error("simulated beyond the last frame");
  append(*kept_, frame->boxes);
  ++known_;
}

scenes::AuthoredScene FrameProvider::authoredScene(std::uint32_t index) {
  if (auto* whole = dynamic_cast<scenes::SceneSource*>(simulation_.get());
      whole && index == known_) {
    return whole->authoredScene();
  }
  // Of other simulations, such as replays, only the boxes are known.
  return scenes::sceneFromFrame(*frames_, index);
}

FrameOpener FrameProvider::opener() const {
  if (!kept_) {
    return [name = frames_->name(), swept = swept_](std::uint32_t /*last*/) {
      return shown(openRecordingFile(name), swept);
    };
  }
  auto scene =
      std::make_shared<const SceneInfo>(simulation_ ? simulation_->scene() : this->scene());
  return [scene = std::move(scene), kept = kept_, swept = swept_](std::uint32_t last) {
    SceneInfo known = *scene;
    known.frames = last;
    return shown(std::make_unique<KeptFrames>(std::move(known), kept), swept);
  };
}

}  // namespace broadmark
