#include "inspector/footage.h"

#include <fmt/format.h>
#include <unistd.h>

#include "broadmark/error.h"
#include "broadmark/scenes/authored_simulation.h"

namespace broadmark {
namespace {

constexpr const char* kKeptName = "the frames simulated so far";

/// Reads frame `index` of a file of frames into `boxes`.
void readKept(const FileDescriptor& kept, std::uint32_t index, std::span<Aabb> boxes) {
  const auto bytes = std::as_writable_bytes(boxes);
  const std::uint64_t start = std::uint64_t{index} * bytes.size();
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got = ::pread(kept.get(), bytes.data() + done, bytes.size() - done,
                                static_cast<off_t>(start + done));
    if (got <= 0) throw InputError(fmt::format("{}: cannot read frame {}", kKeptName, index));
    done += static_cast<std::size_t>(got);
  }
}

/// Frames 0…F, each to be had by its number through `read`.
class NumberedFrames final : public FrameSource {
 public:
  using Read = std::function<Frame(std::uint32_t)>;
  NumberedFrames(SceneInfo scene, Read read) : scene_(std::move(scene)), read_(std::move(read)) {}

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }
  Frame rewind() override {
    index_ = 0;
    return read_(0);
  }
  std::optional<Frame> next() override {
    if (index_ == scene_.frames) return {};
    return read_(++index_);
  }

 private:
  SceneInfo scene_;
  Read read_;
  std::uint32_t index_ = 0;
};

}  // namespace

Footage::Footage(std::unique_ptr<Recording> recording)
    : scene_(recording->scene()), known_(scene_.frames), recording_(std::move(recording)) {}

Footage::Footage(std::unique_ptr<Simulation> simulation)
    : simulation_(std::move(simulation)),
      kept_(std::make_shared<const FileDescriptor>(unnamedFile())) {
  const Frame first = simulation_->rewind();
  scene_ = simulation_->scene();
  keep(first.boxes);
}

Footage::Footage(SceneInfo scene, std::span<const Aabb> boxes)
    : scene_(std::move(scene)), kept_(std::make_shared<const FileDescriptor>(unnamedFile())) {
  keep(boxes);
}

void Footage::keep(std::span<const Aabb> boxes) {
  boxes_.assign(boxes.begin(), boxes.end());
  writeAll(kept_->get(), std::as_bytes(boxes), kKeptName);
}

void Footage::extend() {
  const std::optional<Frame> frame = simulation_->next();
  if (!frame) throw std::logic_error("simulated beyond the last frame");
  keep(frame->boxes);
  ++known_;
}

Frame Footage::read(std::uint32_t index) {
  if (recording_) return recording_->read(index);
  boxes_.resize(scene_.objects);
  readKept(*kept_, index, boxes_);
  return {index, boxes_};
}

scenes::AuthoredScene Footage::authoredScene(std::uint32_t index) {
  if (recording_) return scenes::sceneFromFrame(*recording_, index);
  if (auto* whole = dynamic_cast<scenes::SceneSource*>(simulation_.get());
      whole && index == known_) {
    return whole->authoredScene();
  }
  // Of all else, a replay among them, only the boxes are at hand.
  return scenes::sceneFromFrame(*source(index), index);
}

std::unique_ptr<FrameSource> Footage::source(std::uint32_t last) const {
  SceneInfo scene = scene_;
  scene.frames = last;
  if (recording_) {
    const std::shared_ptr<Recording> opened = openRecordingFile(recording_->name());
    return std::make_unique<NumberedFrames>(
        scene, [opened](std::uint32_t index) { return opened->read(index); });
  }
  auto boxes = std::make_shared<std::vector<Aabb>>(scene.objects);
  return std::make_unique<NumberedFrames>(scene, [kept = kept_, boxes](std::uint32_t index) {
    readKept(*kept, index, *boxes);
    return Frame{index, *boxes};
  });
}

void Footage::save(const std::filesystem::path& path) {
  SceneInfo saved = scene_;
  saved.frames = known_;
  RecordingWriter writer(path, saved);
  for (std::uint32_t index = 0; index <= known_; ++index) writer.write(read(index).boxes);
  writer.finish();
}

}  // namespace broadmark
