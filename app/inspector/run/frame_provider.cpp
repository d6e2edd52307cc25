#include "inspector/run/frame_provider.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/recordings/adapted_frames.h"
#include "broadmark/scenes/authored_simulation.h"

namespace broadmark {
namespace {

constexpr const char* kTemporaryName = "the frames simulated so far";

/// Reads a file of boxes, frame after frame. Frames not written yet cannot be read.
class TemporaryFrames final : public IndexedFrames {
 public:
  TemporaryFrames(SceneInfo scene, std::shared_ptr<const FileDescriptor> file)
      : scene_(std::move(scene)), file_(std::move(file)), boxes_(scene_.objects) {}

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    const auto bytes = std::as_writable_bytes(std::span(boxes_));
    if (readAll(file_->get(), bytes, std::uint64_t{index} * bytes.size()) < bytes.size()) {
      throw InputError(fmt::format("{}: cannot read frame {}", kTemporaryName, index));
    }
    return boxes_;
  }

  SceneInfo scene_;
  std::shared_ptr<const FileDescriptor> file_;
  std::vector<Aabb> boxes_;
};

void append(const FileDescriptor& file, std::span<const Aabb> boxes) {
  writeAll(file.get(), std::as_bytes(boxes), kTemporaryName);
}

}  // namespace

FrameProvider::FrameProvider(std::unique_ptr<Recording> recording, ParameterValues reading)
    : reading_(std::move(reading)),
      available_(recording->scene().frames),
      frames_(adapted(std::move(recording), reading_)) {}

FrameProvider::FrameProvider(std::unique_ptr<FrameSource> simulation, ParameterValues reading)
    : reading_(std::move(reading)), simulation_(std::move(simulation)) {
  const Frame first = simulation_->rewind();
  store(simulation_->scene(), first.boxes);
}

FrameProvider::FrameProvider(SceneInfo scene, std::span<const Aabb> boxes) { store(scene, boxes); }

void FrameProvider::store(const SceneInfo& scene, std::span<const Aabb> first) {
  file_ = std::make_shared<const FileDescriptor>(unnamedFile());
  frames_ = adapted(std::make_unique<TemporaryFrames>(scene, file_), reading_);
  append(*file_, first);
}

void FrameProvider::simulateNext() {
  const std::optional<Frame> frame = simulation_->next();
  if (!frame) throw std::logic_error("simulated beyond the last frame");
  append(*file_, frame->boxes);
  ++available_;
}

scenes::AuthoredScene FrameProvider::authoredScene(std::uint32_t index) {
  if (auto* scene_source = dynamic_cast<scenes::SceneSource*>(simulation_.get());
      scene_source && index == available_) {
    return scene_source->authoredScene();
  }
  // Other simulations, such as replays, provide only the boxes.
  return scenes::sceneFromFrame(*frames_, index);
}

FrameOpener FrameProvider::opener() const {
  if (!file_) {
    return [name = frames_->name(), reading = reading_](std::uint32_t /*last*/) {
      return adapted(openRecordingFile(name), reading);
    };
  }
  auto scene =
      std::make_shared<const SceneInfo>(simulation_ ? simulation_->scene() : this->scene());
  return [scene = std::move(scene), file = file_, reading = reading_](std::uint32_t last) {
    SceneInfo available = *scene;
    available.frames = last;
    return adapted(std::make_unique<TemporaryFrames>(std::move(available), file), reading);
  };
}

}  // namespace broadmark
