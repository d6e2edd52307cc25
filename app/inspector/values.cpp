// The session's state as text, by name, for scripts and tests.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <optional>
#include <span>

#include "inspector/inspector.h"
#include "inspector/session/answer_text.h"
#include "inspector/session/track_statistics.h"
#include "inspector/session/wrong_pair.h"

namespace broadmark {
namespace {

const char* yesOrNo(bool value) { return value ? "yes" : "no"; }

std::string textOf(bool value) { return yesOrNo(value); }
std::string textOf(std::integral auto number) { return std::to_string(number); }
std::string textOf(double number) { return fmt::format("{:.6g}", number); }
template <std::size_t count>
std::string textOf(const std::array<float, count>& numbers) {
  constexpr std::string_view kFormat = count == 4 ? "{:.4g}" : "{:.6g}";
  return fmt::format(kFormat, fmt::join(numbers, " "));
}

void addTracks(Values& values, const Session& session, const RunProgress& progress) {
  for (const TrackReport& track : progress.tracks) {
    const std::string name = "algorithm." + track.spec.test_case.algorithm.id + ".";
    values[name + "status"] = statusName(track.status);
    values[name + "reason"] = track.reason;
    values[name + "frame"] = std::to_string(track.frame);
    values[name + "over"] = std::to_string(framesOver(track, session.timeline.budget_ms));
    for (const FrameCount count : {FrameCount::missed, FrameCount::false_pairs,
                                   FrameCount::allowed_extra, FrameCount::invalid}) {
      std::uint64_t sum = 0;
      for (const FrameRecord& record : track.frames) sum += record.counts[count];
      values[name + std::string(kFrameCounts.nameOf(count))] = std::to_string(sum);
    }
    const FrameRecord* record = track.record(track.frame);
    values[name + "pairs"] = record ? std::to_string(record->counts[FrameCount::pairs]) : "";
    if (const auto span = session.timeline.span()) {
      const auto in_span = statisticsOf(track.curves.pairs, track.curves.disturbed, *span);
      values[name + "span_frames"] = std::to_string(in_span.values.size() + in_span.disturbed);
    }
  }
}

void addSnapshot(Values& values, const Snapshot* shown) {
  const Snapshot none;
  const Snapshot& snapshot = shown ? *shown : none;
  const FrameDifference& difference = snapshot.difference;
  values["shown_frame"] = shown ? std::to_string(snapshot.frame) : "";
  values["bodies"] = std::to_string(snapshot.present);
  values["pairs"] = std::to_string(snapshot.pairs.size());
  values["missed"] = std::to_string(difference.missed_count);
  values["false"] = std::to_string(difference.false_count);
  values["allowed_extra"] = std::to_string(difference.allowed_extra_count);
  values["invalid"] = std::to_string(difference.invalid_count);
  values["mismatch_pairs"] =
      std::to_string(difference.missed_count + difference.false_count + difference.invalid_count);
  const RecordedDrawing* structure = snapshot.structure.get();
  values["structure"] =
      std::to_string(structure ? structure->boxes().size() + structure->lines().size() : 0);
}

void addSecond(Values& values, const Session& session, const RunProgress& progress) {
  const Snapshot* second = progress.second.get();
  values["second"] = yesOrNo(session.second.has_value());
  values["second.frame"] = second ? std::to_string(second->frame) : "";
  values["second.pairs"] = second ? std::to_string(second->pairs.size()) : "";
  values["second.bodies"] = second ? std::to_string(second->present) : "";
  const PairComparison* comparison = progress.comparison.get();
  const auto count = [&](const std::vector<Pair> PairComparison::* pairs) {
    return comparison ? std::to_string((comparison->*pairs).size()) : "";
  };
  values["compare.both"] = comparison ? std::to_string(comparison->both) : "";
  values["compare.first_only"] = count(&PairComparison::first_only);
  values["compare.second_only"] = count(&PairComparison::second_only);
  values["second.failure"] = progress.second_failure;
}

/// "overlapping 12, free 28"
std::string legendText(const std::vector<LegendEntry>& legend) {
  std::string text;
  for (const LegendEntry& entry : legend) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", entry.label, entry.count);
  }
  return text;
}

void addTimeline(Values& values, const Timeline& timeline) {
  values["timeline.first"] = fmt::format("{:.1f}", timeline.first());
  values["timeline.last"] = fmt::format("{:.1f}", timeline.last());
  values["timeline.zoomed"] = yesOrNo(timeline.zoomed());
  const auto span = timeline.span();
  values["timeline.span"] = span ? fmt::format("{}-{}", span->first, span->last) : "";
}

void addAuthored(Values& values, Session& session) {
  const Document& document = session.document;
  const scenes::AuthoredScene& scene = document.editor.scene();
  values["author.shown"] = yesOrNo(document.shown());
  values["author.at_rest"] = yesOrNo(document.atRest());
  values["author.name"] = scene.name;
  values["author.bodies"] = std::to_string(scene.bodies.size());
  values["author.selection"] = std::to_string(document.editor.selection().size());
  values["author.undo"] = document.editor.undoName();
  values["author.redo"] = document.editor.redoName();
  values["author.modified"] = yesOrNo(document.isModified());
  values["author.path"] = document.path().string();
  values["author.tool"] = kTools.nameOf(document.tools.tool);
  values["author.local"] = yesOrNo(document.tools.local);
  values["author.leaving"] = yesOrNo(document.pending_close != nullptr);
  for (const auto& [name, value] : scene.parameters) values["author.parameter." + name] = value;
  if (document.editor.selection().empty()) return;
  const scenes::AuthoredBody& body = scene.bodies[document.editor.selection().front()];
  visitProperties(body, [&](const std::string& key, const auto& value, const auto& /*default*/) {
    values["author.body." + key] = textOf(value);
  });
  if (body.vanishes == scenes::kNever) values["author.body.vanishes"] = "never";
  const auto* sphere = std::get_if<scenes::SphereShape>(&body.shape);
  values["author.body.shape"] = sphere ? "sphere" : "box";
  values["author.body.size"] =
      textOf(sphere ? Vec3{2 * sphere->radius, 0, 0} : scenes::edgesOf(body.shape));
}

void addCases(Values& values, std::optional<OpenedResults>& results) {
  const auto rows = results ? std::span(results->rows()) : std::span<const OpenedResults::Row>();
  values["cases"] = results ? std::to_string(rows.size()) : "";
  values["cases.listed"] = results ? std::to_string(results->listed().size()) : "";
  values["cases.marked"] = std::to_string(std::ranges::count_if(rows, &OpenedResults::Row::marked));
  values["cases.wrong"] = results ? std::to_string(results->wrongCount()) : "";
  values["cases.scaling"] = results ? std::to_string(results->scaling(Phase::total).size()) : "";
  const bool compared = results && results->compared() != nullptr;
  values["cases.compared"] = compared ? summaryText(results->compared()->comparison) : "";
  const bool any = results && !results->listed().empty();
  values["cases.first"] = any ? rows[results->listed().front()].result.id : "";
}

/// Presence of the first selected body.
std::string presenceText(const Session& session, const Snapshot* snapshot) {
  const auto& bodies = session.selection.bodies();
  if (bodies.empty() || !snapshot || bodies.front() >= snapshot->boxes->size()) return "";
  if (!isEmpty((*snapshot->boxes)[bodies.front()])) return "present";
  return snapshot->trails.empty() ? "absent" : absenceText(snapshot->trails.front());
}

/// Adds values of the selected pair, if exactly two bodies are selected.
void addPair(Values& values, const Session& session, const Snapshot* snapshot) {
  const auto& bodies = session.selection.bodies();
  const bool is_pair = bodies.size() == 2;
  values["pair"] = is_pair ? pairName({bodies[0], bodies[1]}) : "";
  if (!is_pair || !snapshot || bodies[1] >= snapshot->boxes->size()) return;
  const auto [a, b] = nearestImages((*snapshot->boxes)[bodies[0]], (*snapshot->boxes)[bodies[1]],
                                    snapshot->scene.periodic);
  for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
    const AxisRelation relation = axisRelation(axis, a, b);
    values[fmt::format("pair.gap.{}", kAxes[axis])] = fmt::format("{}", relation.gap);
    values[fmt::format("pair.relation.{}", kAxes[axis])] = kRelations.nameOf(relation.type);
  }
  values["pair.axis"] = kAxes[maxSeparationAxis(a, b)];
  values["pair.overlaps"] = yesOrNo(overlaps(a, b));
  values["pair.history"] =
      snapshot->trails.size() == 2 ? std::to_string(snapshot->trails[0].boxes.size()) : "0";
}

Values valuesOf(Session& session, const RunProgress& progress) {
  Values values;
  values["frame"] = std::to_string(session.playback.frame());
  values["last_frame"] = std::to_string(session.playback.lastFrame());
  values["known_frames"] = std::to_string(progress.available_frames);
  values["doing"] = progress.activity;
  values["playing"] = yesOrNo(session.playback.playing());
  const auto rate = session.playback.achievedRate();
  values["achieved"] = rate ? fmt::format("{:.1f}", *rate) : "";
  values["loop"] = yesOrNo(session.playback.loop);
  values["speed"] = fmt::format("{:g}", session.playback.frames_per_second);
  values["source"] = sourceText(progress.source.get());
  values["title"] = progress.source ? progress.source->title : "";
  values["scene"] = progress.scene.name;
  values["object_type"] = progress.scene.object_type;
  values["algorithms"] = std::to_string(session.tracks.list.size());
  values["selection"] = fmt::format("{}", session.selection.bodies().size());
  values["colouring"] = std::to_string(session.display.colouring);
  values["colours"] = session.display.colourMode().id;
  values["hide_free"] = yesOrNo(session.display.hide_free);
  values["pair_lines"] = yesOrNo(session.display.pair_lines);
  values["check"] = yesOrNo(session.mismatches.check);
  values["stop_frame"] = progress.stop ? std::to_string(progress.stop->frame) : "";
  values["error"] = session.notices.errors.empty() ? "" : session.notices.errors.front();
  values["status"] = session.notices.status.text;
  for (const auto& [name, value] : parameterValues(session.draft.scene()))
    values["scene." + name] = value;
  for (const auto& [name, value] : sceneParametersOf(session.playback.source().get()))
    values["open." + name] = value;
  for (TrackEdit& track : session.tracks.list) {
    for (const auto& [name, value] : parameterValues(*track.parameters)) {
      values[fmt::format("algorithm.{}.{}", track.test_case.algorithm.id, name)] = value;
    }
    values[fmt::format("algorithm.{}.threads", track.test_case.algorithm.id)] =
        std::to_string(track.test_case.threads);
    values[fmt::format("algorithm.{}.isa", track.test_case.algorithm.id)] =
        isaName(track.test_case.isa);
  }
  const TrackEdit* shown = session.tracks.find(session.tracks.shown());
  values["shown_algorithm"] = shown != nullptr ? shown->test_case.algorithm.id : "";
  addAuthored(values, session);
  for (const Job* const job : session.jobs.all()) {
    for (const auto& [name, value] : job->status().values) {
      values[fmt::format("{}.{}", job->value_prefix, name)] = value;
    }
  }
  addTracks(values, session, progress);
  addTimeline(values, session.timeline);
  addSnapshot(values, progress.snapshot.get());
  addSecond(values, session, progress);
  values["selected_body"] = presenceText(session, progress.snapshot.get());
  addPair(values, session, progress.snapshot.get());
  const auto& examined = session.mismatches.examined();
  values["examined"] = examined ? pairName(examined->pair) : "";
  values["replaying"] = yesOrNo(session.playback.replaying());
  values["searching"] = yesOrNo(session.mismatches.searching());
  addCases(values, session.results);
  return values;
}

}  // namespace

std::optional<std::string> Inspector::value(const std::string& name) {
  Values values;
  session_.runs.readProgress(
      [&](const RunProgress& progress) { values = valuesOf(session_, progress); });
  values["panel.left"] = preferences_.tabs["left"];
  values["panel.right"] = preferences_.tabs["right"];
  values["panel.bottom"] = preferences_.tabs["bottom"];
  for (const View& view : views_.list()) {
    const std::string prefix = &view == &views_.first() ? "view." : "second.";
    values[prefix + "where"] = view.answer().where;
    values[prefix + "answer"] = view.answer().answer;
    values[prefix + "oracle"] = view.answer().comparison;
    values[prefix + "pair"] = view.answer().pair;
    const auto& deciding = view.content().deciding_axis;
    values[prefix + "axis"] = deciding ? kAxes[deciding->axis] : "";
    values[prefix + "glass"] = std::to_string(view.content().glassBodies());
    values[prefix + "yaw"] = fmt::format("{:.4f}", view.camera().yaw);
    values[prefix + "distance"] = fmt::format("{:.4f}", view.camera().distance);
  }
  View& first = views_.first();
  values["camera.yaw"] = values["view.yaw"];
  values["camera.pitch"] = fmt::format("{:.4f}", first.camera().pitch);
  values["camera.distance"] = values["view.distance"];
  values["legend"] = legendText(first.content().colouring.legend);
  values["legend.oracle"] = legendText(first.content().oracle_legend);
  values["legend.cells"] = legendText(first.content().cell_legend);
  values["view.hands"] = first.hands().text();
  values["hidden"] = std::to_string(first.content().hiddenBodies());
  values["glyphs.missing"] = std::to_string(ui_.glyphs.missing());
  values["scale"] = fmt::format("{:g}", ui_.scale);
  values["layout"] =
      fmt::format("{:g} {:g} {:g}", preferences_.left, preferences_.right, preferences_.bottom);
  values["theme"] = preferences_.dark ? "dark" : "light";
  values["start_page"] = yesOrNo(start_page_.isShown(session_));
  values["recoverable"] = std::to_string(autosave_.left().size());
  values["maximised"] = view_alone_ ? "View" : maximised_ ? kDockAreas.nameOf(*maximised_) : "";
  values["hidden_panels"] = fmt::format("{}", fmt::join(preferences_.hidden, ", "));
  values["picture_rate"] = rate_.shown ? rate_.text : "";
  values["help"] = yesOrNo(help_open_);
  values["focus"] = ui_.focused();
  values["popup"] =
      yesOrNo(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel));
  values["dialog"] = yesOrNo(files_.isOpen());
  const auto found = values.find(name);
  if (found == values.end()) return {};
  return found->second;
}

}  // namespace broadmark
