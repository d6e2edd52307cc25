// Parts of recordings.

#include "broadmark/sub_recording.h"

#include <fmt/format.h>

#include <numeric>

#include "broadmark/error.h"
#include "broadmark/recording.h"

namespace broadmark {

FrameSeeker::FrameSeeker(FrameSource& source)
    : source_(source), recording_(dynamic_cast<Recording*>(&source)) {}

Frame FrameSeeker::at(std::uint32_t index) {
  if (recording_ != nullptr) return recording_->read(index);
  if (!started_ || index < present_.index) present_ = source_.rewind();
  started_ = true;
  while (present_.index < index) {
    const std::optional<Frame> next = source_.next();
    if (!next) {
      throw InputError(
          fmt::format("{}: no frame {}: the last one is {}", scene().name, index, present_.index));
    }
    present_ = *next;
  }
  return present_;
}

Selection wholeSelection(const SceneInfo& scene, std::uint32_t last_frame) {
  Selection all;
  all.bodies.resize(scene.objects);
  all.frames.resize(std::size_t{last_frame} + 1);
  std::iota(all.bodies.begin(), all.bodies.end(), 0U);
  std::iota(all.frames.begin(), all.frames.end(), 0U);
  return all;
}

SubRecording::SubRecording(FrameSeeker& whole, Selection selection, std::string name)
    : whole_(whole), selection_(std::move(selection)), scene_(whole.scene()) {
  scene_.name = std::move(name);
  scene_.objects = static_cast<std::uint32_t>(selection_.bodies.size());
  scene_.frames = static_cast<std::uint32_t>(selection_.frames.size() - 1);
  boxes_.resize(scene_.objects);
}

std::optional<Frame> SubRecording::next() {
  if (index_ == scene_.frames) return std::nullopt;
  return at(index_ + 1);
}

Frame SubRecording::at(std::uint32_t index) {
  const Frame frame = whole_.at(selection_.frames[index]);
  for (std::size_t i = 0; i < boxes_.size(); ++i) boxes_[i] = frame.boxes[selection_.bodies[i]];
  index_ = index;
  return {index, boxes_};
}

FrameList::FrameList(FrameSource& source) : scene_(source.scene()) {
  boxes_.reserve(std::size_t{scene_.objects} * (std::size_t{scene_.frames} + 1));
  for (std::optional<Frame> frame = source.rewind(); frame; frame = source.next()) {
    boxes_.insert(boxes_.end(), frame->boxes.begin(), frame->boxes.end());
  }
}

std::optional<Frame> FrameList::next() {
  if (index_ == scene_.frames) return std::nullopt;
  return at(index_ + 1);
}

Frame FrameList::at(std::uint32_t index) {
  index_ = index;
  return {index, std::span(boxes_).subspan(std::size_t{index} * scene_.objects, scene_.objects)};
}

}  // namespace broadmark
