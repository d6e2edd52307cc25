// The session's state as text, by name: what scripts and tests assert.

#include <fmt/format.h>

#include <map>

#include "inspector/inspector.h"
#include "inspector/mismatch.h"

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
  values["mismatch_pairs"] = snapshot ? std::to_string(snapshot->difference.missed_count +
                                                       snapshot->difference.forbidden_count +
                                                       snapshot->difference.invalid_count)
                                      : "0";
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

void addAuthored(Values& values, Session& session) {
  const AuthorDesk& desk = session.desk;
  const scenes::AuthoredScene& scene = desk.editor.scene();
  const auto yes = [](bool is) { return is ? "yes" : "no"; };
  values["author.shown"] = yes(session.authoring());
  values["author.at_rest"] = yes(session.authoringAtRest());
  values["author.name"] = scene.name;
  values["author.bodies"] = std::to_string(scene.bodies.size());
  values["author.selection"] = std::to_string(desk.editor.selection().size());
  values["author.undo"] = desk.editor.undoName();
  values["author.redo"] = desk.editor.redoName();
  values["author.modified"] = yes(desk.isModified());
  values["author.path"] = desk.path().string();
  values["author.leaving"] = yes(session.leaving != nullptr);
  for (const auto& [name, value] : scene.parameters) values["author.parameter." + name] = value;
  if (desk.editor.selection().empty()) return;
  const scenes::AuthoredBody& body = scene.bodies[desk.editor.selection().front()];
  const auto vec = [](const Vec3& v) {
    return fmt::format("{:.6g} {:.6g} {:.6g}", v[0], v[1], v[2]);
  };
  values["author.body.position"] = vec(body.pose.position);
  values["author.body.velocity"] = vec(body.linear_velocity);
  values["author.body.angular_velocity"] = vec(body.angular_velocity);
  values["author.body.mass"] = fmt::format("{:.6g}", body.mass);
  values["author.body.frozen"] = yes(body.frozen);
  const auto* box = std::get_if<scenes::BoxShape>(&body.shape);
  values["author.body.shape"] = box ? "box" : "sphere";
  values["author.body.size"] =
      vec(box ? Vec3{2 * box->half_extents[0], 2 * box->half_extents[1], 2 * box->half_extents[2]}
              : Vec3{2 * std::get<scenes::SphereShape>(body.shape).radius, 0, 0});
}

void addBatch(Values& values, const BackgroundBake& bake) {
  using Outcome = BackgroundBake::Outcome;
  const BackgroundBake::Report report = bake.report();
  values["batch.state"] = bakeStateName(report.state);
  values["batch.recordings"] = std::to_string(report.items.size());
  values["batch.done"] = std::to_string(report.count(Outcome::baked));
  values["batch.kept"] = std::to_string(report.count(Outcome::kept));
  values["batch.failed"] = std::to_string(report.failed());
}

/// Of the two selected bodies, if there are two.
void addPair(Values& values, const Session& session, const Snapshot* snapshot) {
  const auto& bodies = session.selection;
  const bool chosen = bodies.size() == 2;
  values["pair"] = chosen ? pairName({bodies[0], bodies[1]}) : "";
  if (!chosen || !snapshot || bodies[1] >= snapshot->boxes->size()) return;
  const Aabb& a = (*snapshot->boxes)[bodies[0]];
  const Aabb& b = (*snapshot->boxes)[bodies[1]];
  constexpr std::string_view kAxes = "xyz";
  for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
    const AxisRelation relation = relationOn(axis, a, b);
    values[fmt::format("pair.gap.{}", kAxes[axis])] = fmt::format("{}", relation.gap);
    values[fmt::format("pair.relation.{}", kAxes[axis])] = relationName(relation.kind);
  }
  values["pair.axis"] = kAxes[decidingAxis(a, b)];
  values["pair.overlaps"] = overlaps(a, b) ? "yes" : "no";
  values["pair.history"] =
      snapshot->tracks.size() == 2 ? std::to_string(snapshot->tracks[0].boxes.size()) : "0";
}

void addExport(Values& values, const CaseExport::Report& report) {
  values["export.state"] = exportStateName(report.state);
  values["export.trials"] = std::to_string(report.trials);
  values["export.bodies"] = std::to_string(report.bodies);
  values["export.frames"] = std::to_string(report.frames);
  values["export.file"] = report.file.string();
  values["export.command"] = report.command;
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
  addAuthored(values, session);
  addBatch(values, session.bake);
  addLanes(values, progress);
  addSnapshot(values, progress.snapshot.get());
  addPair(values, session, progress.snapshot.get());
  addExport(values, session.case_export.report());
  values["searching"] = session.searching() ? "yes" : "no";
  values["cases"] = session.case_choice ? std::to_string(session.case_choice->cases.size()) : "";
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
