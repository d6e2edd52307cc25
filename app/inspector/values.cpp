// The session's state as text, by name: what scripts and tests assert.

#include <fmt/format.h>

#include <map>

#include "app/inspector/inspector.h"

namespace broadmark {
namespace {

using Values = std::map<std::string, std::string>;

void addLanes(Values& values, const RunProgress& progress) {
  for (const LaneReport& lane : progress.lanes) {
    const std::string name = "lane." + lane.spec.run.algorithm.id + ".";
    values[name + "status"] = statusName(lane.status);
    values[name + "frame"] = std::to_string(lane.frame);
    std::uint64_t missed = 0;
    std::uint64_t extra = 0;
    for (const FrameRecord& record : lane.frames) {
      missed += record.missed;
      extra += record.extra;
    }
    values[name + "missed"] = std::to_string(missed);
    values[name + "extra"] = std::to_string(extra);
    const FrameRecord* record = lane.record(lane.frame);
    values[name + "pairs"] = record ? std::to_string(record->pairs) : "";
  }
}

void addSnapshot(Values& values, const Snapshot* snapshot) {
  values["shown_frame"] = snapshot ? std::to_string(snapshot->frame) : "";
  values["bodies"] = snapshot ? std::to_string(snapshot->boxes->size()) : "0";
  values["pairs"] = snapshot ? std::to_string(snapshot->pairs.size()) : "0";
  values["missed"] = snapshot ? std::to_string(snapshot->difference.missed_count) : "0";
  values["extra"] = snapshot ? std::to_string(snapshot->difference.extra_count) : "0";
  values["structure"] = snapshot && snapshot->structure
                            ? std::to_string(snapshot->structure->boxes().size() +
                                             snapshot->structure->lines().size())
                            : "0";
}

/// "overlapping 12, free 28"
std::string legendText(const std::vector<LegendEntry>& legend) {
  std::string text;
  for (const LegendEntry& entry : legend) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", entry.label, entry.count);
  }
  return text;
}

Values valuesOf(Session& session, const RunProgress& progress) {
  Values values;
  values["frame"] = std::to_string(session.frame());
  values["last_frame"] = std::to_string(session.lastFrame());
  values["known_frames"] = std::to_string(progress.known_frames);
  values["playing"] = session.playback.playing ? "yes" : "no";
  values["loop"] = session.playback.loop ? "yes" : "no";
  values["speed"] = fmt::format("{:g}", session.playback.frames_per_second);
  values["title"] = progress.footage ? progress.footage->title : "";
  values["scene"] = progress.scene.name;
  values["object_type"] = progress.scene.object_type;
  values["lanes"] = std::to_string(session.lanes.size());
  values["selection"] = fmt::format("{}", session.selection.size());
  values["colouring"] = std::to_string(session.view.colouring);
  values["hide_free"] = session.view.hide_free ? "yes" : "no";
  values["pair_lines"] = session.view.pair_lines ? "yes" : "no";
  values["check"] = session.wish.check ? "yes" : "no";
  values["stop_frame"] = progress.stop ? std::to_string(progress.stop->frame) : "";
  values["error"] = session.errors.empty() ? "" : session.errors.front();
  values["status"] = session.status.text;
  for (const auto& [name, value] : parameterValues(*session.draft)) values["scene." + name] = value;
  for (LaneEdit& lane : session.lanes) {
    for (const auto& [name, value] : parameterValues(*lane.parameters)) {
      values[fmt::format("lane.{}.{}", lane.algorithm.id, name)] = value;
    }
    values[fmt::format("lane.{}.threads", lane.algorithm.id)] = std::to_string(lane.threads);
    values[fmt::format("lane.{}.isa", lane.algorithm.id)] = isaName(lane.isa);
  }
  const LaneEdit* shown = session.lane(session.wish.shown_lane);
  values["shown_lane"] = shown != nullptr ? shown->algorithm.id : "";
  addLanes(values, progress);
  addSnapshot(values, progress.snapshot.get());
  return values;
}

}  // namespace

std::optional<std::string> Inspector::value(const std::string& name) {
  Values values;
  session_.runs.look([&](const RunProgress& progress) { values = valuesOf(session_, progress); });
  values["panel.left"] = preferences_.tabs["left"];
  values["panel.right"] = preferences_.tabs["right"];
  values["panel.bottom"] = preferences_.tabs["bottom"];
  values["camera.yaw"] = fmt::format("{:.4f}", view_.camera().yaw);
  values["camera.pitch"] = fmt::format("{:.4f}", view_.camera().pitch);
  values["camera.distance"] = fmt::format("{:.4f}", view_.camera().distance);
  values["legend"] = legendText(view_.legend());
  values["theme"] = preferences_.dark ? "dark" : "light";
  values["help"] = help_ ? "yes" : "no";
  values["dialog"] = files_.isOpen() ? "yes" : "no";
  const auto found = values.find(name);
  if (found == values.end()) return {};
  return found->second;
}

}  // namespace broadmark
