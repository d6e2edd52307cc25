#include "broadmark/recordings/adapted_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <ranges>
#include <span>
#include <string_view>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/hasher.h"
#include "broadmark/recordings/ordered_frames.h"
#include "broadmark/recordings/periodic_frames.h"
#include "broadmark/recordings/swept_frames.h"
#include "broadmark/recordings/widened_frames.h"

namespace broadmark {
namespace {

/// `value` is that of the option.
struct FrameAdapter {
  std::string_view option;
  std::string_view suffix;  ///< of the scene's name
  SceneInfo (*scene)(SceneInfo, const std::string& value);
  std::unique_ptr<IndexedFrames> (*wrap)(std::unique_ptr<IndexedFrames>, const std::string& value);
};

double distanceOf(const std::string& value) {
  double distance = 0;
  setParameter({"widen", "", &distance, 0, kMaxWidening}, value);
  return distance;
}

const std::array adapters{
    FrameAdapter{"swept", kSweptSuffix,
                 [](SceneInfo scene, const std::string&) { return sweptScene(std::move(scene)); },
                 [](std::unique_ptr<IndexedFrames> frames,
                    const std::string&) -> std::unique_ptr<IndexedFrames> {
                   return std::make_unique<SweptFrames>(std::move(frames));
                 }},
    FrameAdapter{"widen", kWidenedSuffix,
                 [](SceneInfo scene, const std::string& value) {
                   return widenedScene(std::move(scene), distanceOf(value));
                 },
                 [](std::unique_ptr<IndexedFrames> frames,
                    const std::string& value) -> std::unique_ptr<IndexedFrames> {
                   return widened(std::move(frames), distanceOf(value));
                 }},
    FrameAdapter{"periodic", kPeriodicSuffix, periodicScene, periodicFrames},
    FrameAdapter{"body_order", kOrderedSuffix,
                 [](SceneInfo scene, const std::string&) { return orderedScene(std::move(scene)); },
                 [](std::unique_ptr<IndexedFrames> frames,
                    const std::string& value) -> std::unique_ptr<IndexedFrames> {
                   const auto order = value == "random" ? BodyOrder::random : BodyOrder::morton;
                   return std::make_unique<OrderedFrames>(std::move(frames), order);
                 }},
};

/// The value of the adapter's option; null without it.
const std::string* valueOf(const FrameAdapter& adapter, const ParameterValues& reading) {
  const auto value = reading.find(std::string(adapter.option));
  return value == reading.end() ? nullptr : &value->second;
}

/// The options for frames of this scene: a periodic world needs no option.
ParameterValues optionsFor(const SceneInfo& scene, ParameterValues reading) {
  if (scene.periodic.repeats()) reading.try_emplace("periodic", kStatedPeriodicBox);
  if (reading.contains("swept") && reading.contains("periodic")) {
    throw InputError(fmt::format(
        "{}: --swept: a body that crosses a periodic boundary jumps: give --swept or --periodic, "
        "not both",
        scene.name));
  }
  return reading;
}

}  // namespace

Frame AdaptedFrames::readSource(std::uint32_t index) {
  const Frame frame = frames_->at(index);
  filter_ = frame.filter;
  filter_changed_ = frame.filter_changed;
  reports_changes_ = frame.changed.has_value();
  return frame;
}

std::optional<std::span<const std::uint32_t>> AdaptedFrames::changed() const {
  if (!reports_changes_) return {};
  return changed_;
}

ParameterValues adaptersIn(ParameterValues reading) {
  std::erase_if(reading, [](const auto& option) {
    return std::ranges::find(adapters, option.first, &FrameAdapter::option) == adapters.end();
  });
  return reading;
}

std::unique_ptr<IndexedFrames> adapted(std::unique_ptr<IndexedFrames> frames,
                                       const ParameterValues& reading) {
  const ParameterValues options = optionsFor(frames->scene(), reading);
  for (const FrameAdapter& adapter : adapters) {
    const std::string* value = valueOf(adapter, options);
    if (value != nullptr) frames = adapter.wrap(std::move(frames), *value);
  }
  return frames;
}

SceneInfo adaptedScene(SceneInfo scene, const ParameterValues& reading) {
  const ParameterValues options = optionsFor(scene, reading);
  for (const FrameAdapter& adapter : adapters) {
    const std::string* value = valueOf(adapter, options);
    if (value != nullptr) scene = adapter.scene(std::move(scene), *value);
  }
  return scene;
}

std::string unadaptedName(std::string name, const ParameterValues& reading) {
  for (const FrameAdapter& adapter : adapters | std::views::reverse) {
    if (valueOf(adapter, reading) == nullptr || !name.ends_with(adapter.suffix)) continue;
    name.resize(name.size() - adapter.suffix.size());
  }
  return name;
}

std::string adaptedHash(std::string hash, const ParameterValues& reading) {
  for (const FrameAdapter& adapter : adapters) {
    const std::string* value = valueOf(adapter, reading);
    if (value == nullptr || *value == kStatedPeriodicBox) continue;  // part of the hash already
    // A flag has no value of its own.
    const std::string text =
        std::string(adapter.option) + (*value == "on" ? "" : "=" + *value) + " ";
    Hasher hasher;
    hasher.add(std::as_bytes(std::span(text)));
    hasher.add(std::as_bytes(std::span(hash)));
    hash = hasher.hex();
  }
  return hash;
}

}  // namespace broadmark
