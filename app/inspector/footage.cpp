#include "app/inspector/footage.h"

#include <fmt/format.h>
#include <unistd.h>

#include "broadmark/error.h"

namespace broadmark {
namespace {

constexpr const char* kKeptName = "the frames simulated so far";

}  // namespace

Footage::Footage(std::unique_ptr<Recording> recording)
    : scene_(recording->scene()), known_(scene_.frames), recording_(std::move(recording)) {}

Footage::Footage(std::unique_ptr<Simulation> simulation)
    : simulation_(std::move(simulation)), kept_(unnamedFile()) {
  const Frame first = simulation_->rewind();
  scene_ = simulation_->scene();
  keep(first.boxes);
}

void Footage::keep(std::span<const Aabb> boxes) {
  boxes_.assign(boxes.begin(), boxes.end());
  writeAll(kept_.get(), std::as_bytes(boxes), kKeptName);
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
  const auto bytes = std::as_writable_bytes(std::span(boxes_));
  const std::uint64_t start = std::uint64_t{index} * bytes.size();
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got = ::pread(kept_.get(), bytes.data() + done, bytes.size() - done,
                                static_cast<off_t>(start + done));
    if (got <= 0) throw InputError(fmt::format("{}: cannot read frame {}", kKeptName, index));
    done += static_cast<std::size_t>(got);
  }
  return {index, boxes_};
}

void Footage::save(const std::filesystem::path& path) {
  SceneInfo saved = scene_;
  saved.frames = known_;
  RecordingWriter writer(path, saved);
  for (std::uint32_t index = 0; index <= known_; ++index) writer.write(read(index).boxes);
  writer.finish();
}

}  // namespace broadmark
