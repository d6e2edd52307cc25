#include "inspector/run/frame_provider.h"

#include <fmt/format.h>

#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/recordings/adapted_frames.h"
#include "broadmark/scenes/authored_simulation.h"

namespace broadmark {
namespace {

constexpr const char* kTemporaryName = "the frames simulated so far";

}  // namespace

/// The boxes in a file, and the filters if they change. Shared by readers on any thread.
struct FrameProvider::Written {
  FileDescriptor boxes = unnamedFile();

  void append(const SceneInfo& scene, const Frame& frame) {
    writeAll(boxes.get(), std::as_bytes(frame.boxes), kTemporaryName);
    if (!scene.filter_changes) return;
    const std::lock_guard lock(mutex_);
    filters_.push_back(frame.filterIn(scene));
  }
  [[nodiscard]] CollisionFilter filterOf(std::uint32_t frame) const {
    const std::lock_guard lock(mutex_);
    return filters_.at(frame);
  }

 private:
  mutable std::mutex mutex_;
  std::vector<CollisionFilter> filters_;  ///< by frame
};

/// Reads the frames written so far. Frames not written yet cannot be read.
class FrameProvider::TemporaryFrames final : public IndexedFrames {
 public:
  TemporaryFrames(SceneInfo scene, std::shared_ptr<const Written> written)
      : scene_(std::move(scene)), written_(std::move(written)), boxes_(scene_.objects) {}

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    const auto bytes = std::as_writable_bytes(std::span(boxes_));
    if (readAll(written_->boxes.get(), bytes, std::uint64_t{index} * bytes.size()) < bytes.size()) {
      throw InputError(fmt::format("{}: cannot read frame {}", kTemporaryName, index));
    }
    if (scene_.filter_changes) filter_ = written_->filterOf(index);
    return boxes_;
  }
  [[nodiscard]] const CollisionFilter* filter() const override {
    return scene_.filter_changes ? &filter_ : nullptr;
  }

  SceneInfo scene_;
  std::shared_ptr<const Written> written_;
  std::vector<Aabb> boxes_;
  CollisionFilter filter_;  ///< of the last frame read
};

FrameProvider::FrameProvider(std::unique_ptr<Recording> recording, ParameterValues reading)
    : reading_(std::move(reading)),
      available_(recording->scene().frames),
      frames_(adapted(std::move(recording), reading_)) {}

FrameProvider::FrameProvider(std::unique_ptr<FrameSource> simulation, ParameterValues reading)
    : reading_(std::move(reading)), simulation_(std::move(simulation)) {
  const Frame first = simulation_->rewind();
  store(simulation_->scene(), first);
}

FrameProvider::FrameProvider(SceneInfo scene, std::span<const Aabb> boxes) {
  store(scene, {.boxes = boxes});
}

FrameProvider::~FrameProvider() = default;

void FrameProvider::store(const SceneInfo& scene, const Frame& first) {
  written_ = std::make_shared<Written>();
  written_->append(scene, first);
  frames_ = adapted(std::make_unique<TemporaryFrames>(scene, written_), reading_);
}

void FrameProvider::simulateNext() {
  const std::optional<Frame> frame = simulation_->next();
  if (!frame) throw std::logic_error("simulated beyond the last frame");
  written_->append(scene(), *frame);
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
  if (!written_) {
    return [name = frames_->name(), reading = reading_](std::uint32_t /*last*/) {
      return adapted(openRecordingFile(name), reading);
    };
  }
  auto scene =
      std::make_shared<const SceneInfo>(simulation_ ? simulation_->scene() : this->scene());
  return [scene = std::move(scene), written = written_, reading = reading_](std::uint32_t last) {
    SceneInfo available = *scene;
    available.frames = last;
    return adapted(std::make_unique<TemporaryFrames>(std::move(available), written), reading);
  };
}

}  // namespace broadmark
