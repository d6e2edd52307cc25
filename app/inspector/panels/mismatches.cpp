// Analysis of missed and false pairs: the wrong frames and pairs of an algorithm, the two boxes,
// their history, and export of the smallest recording that reproduces the fault.

#include <fmt/format.h>

#include <memory>

#include "broadmark/recordings/recording.h"
#include "broadmark/recordings/sub_recording.h"
#include "inspector/panels/pair_drawing.h"
#include "inspector/panels/panel.h"
#include "inspector/session/wrong_pair.h"
#include "inspector/views/view.h"
#include "support/words.h"

#include <imgui_stdlib.h>  // requires imgui.h

namespace broadmark::panels::mismatches {
namespace {

/// Height of the lists, in rows.
constexpr float kListRows = 4.6F;

class MismatchesPanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    if (progress->tracks.empty()) {
      ui.paragraph(
          "Add an algorithm to compare its answers with the correct ones, frame by frame.");
    } else {
      const TrackReport& track = chooseTrack();
      drawVerdict(track);
      drawSearch();
      drawLists(track);
      drawExportButton(track);
    }
    drawExport();
    drawPair();
    if (!progress->tracks.empty()) drawStructure();
  }

 private:
  /// Draws the choice of the track: by default that of the shown answer, or else the first.
  const TrackReport& chooseTrack() {
    const std::vector<TrackReport>& tracks = progress->tracks;
    std::vector<std::string> names;
    std::size_t chosen = 0;
    for (const TrackReport& track : tracks) {
      if (track.spec.number == session.tracks.shown()) chosen = names.size();
      names.push_back(caseName(track.spec.test_case));
    }
    if (ui.combo("##algorithm", chosen, names, "Algorithm to inspect",
                 ImGui::GetContentRegionAvail().x)) {
      session.tracks.show(tracks[chosen].spec.number);
    }
    return tracks[chosen];
  }

  /// Whether the snapshot shows this track's answer, checked against the oracle.
  bool showsAnswerOf(const TrackReport& track) {
    const auto& snapshot = progress->snapshot;
    return snapshot && snapshot->checked && snapshot->track == track.spec.number;
  }

  void drawVerdict(const TrackReport& track) {
    if (!session.mismatches.check) {
      ui.coloured(ui.theme.warning, "answers are not checked");
      ImGui::SameLine();
      if (ui.button("Check them", "Compare every answer with the oracle's")) {
        session.mismatches.check = true;
      }
      return;
    }
    if (!track.spec.test_case.algorithm.traits.finds_pairs) {
      ui.faint("it reports no pairs by design");
      return;
    }
    if (hasFailed(track)) {
      ui.paragraph(fmt::format("{}: {}", statusName(track.status), track.reason), ui.theme.bad);
      return;
    }
    if (!showsAnswerOf(track)) {
      ui.faint(progress->activity.empty() ? "no answer for this frame"
                                          : progress->activity.c_str());
      return;
    }
    const Snapshot& snapshot = *progress->snapshot;
    const FrameDifference& difference = snapshot.difference;
    if (!difference.isMismatch()) {
      ui.coloured(ui.theme.good, fmt::format("correct in frame {}", snapshot.frame));
      return;
    }
    ui.coloured(ui.theme.bad,
                fmt::format("frame {}: {}", snapshot.frame, mismatchText(difference)));
  }

  void drawSearch() {
    if (session.mismatches.searching()) {
      if (wideButton("Stop here", "Stop at the current frame")) {
        session.mismatches.endSearch(*progress);
      }
    } else if (wideButton("Next mismatch", "Go to the next frame with a mismatch")) {
      session.mismatches.goToNext(*progress);
    }
  }

  void drawLists(const TrackReport& track) {
    const float height = kListRows * ImGui::GetTextLineHeightWithSpacing();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::BeginChild("frames", {0.38F * width, height}, true, ImGuiWindowFlags_NavFlattened);
    drawFrames(track);
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("pairs", {0, height}, true, ImGuiWindowFlags_NavFlattened);
    drawPairs(track);
    ImGui::EndChild();
  }

  void drawFrames(const TrackReport& track) {
    std::vector<std::uint32_t> wrong;
    const FrameValues& marks = track.curves.mismatches;
    for (auto frame = marks.firstKnown(0, marks.size()); frame;
         frame = marks.firstKnown(*frame + 1, marks.size())) {
      wrong.push_back(*frame);
    }
    if (wrong.empty()) ui.faintParagraph("no wrong frame so far");
    clipped(wrong.size(), [&](std::size_t row) {
      const std::string name = fmt::format("frame {}", wrong[row]);
      if (ui.selectable(name.c_str(), wrong[row] == session.playback.frame())) {
        session.playback.goTo(wrong[row]);
      }
    });
  }

  void drawPairs(const TrackReport& track) {
    if (!showsAnswerOf(track)) return;
    const Snapshot& snapshot = *progress->snapshot;
    const std::vector<WrongPair> wrong = wrongPairs(snapshot.difference);
    if (wrong.empty()) ui.faint("no wrong pairs");
    clipped(wrong.size(), [&](std::size_t row) {
      const auto& [kind, pair] = wrong[row];
      const std::string name = fmt::format("{} {}", kind->name, pairName(pair));
      const std::vector<std::uint32_t> bodies = {pair.a, pair.b};
      const bool clicked = ui.selectable(
          name.c_str(), session.selection.bodies() == bodies,
          kind == &kWrongKinds.back() ? "Apart, but within the algorithm's margin: no mismatch"
                                      : "Select both bodies and move the camera to them",
          ui.theme.*kind->colour);
      if (row == 0) ui.note("first pair");
      if (clicked) session.mismatches.examine({pair, snapshot.frame});
    });
    std::uint64_t all = 0;
    for (const WrongKind& kind : kWrongKinds) all += snapshot.difference.*kind.count;
    if (all > wrong.size()) ui.faint(fmt::format("… and {} more", all - wrong.size()));
  }

  /// The frame in which a track fails; its source is null if it does not.
  Session::FailingFrame failingFrame(const TrackReport& track) {
    if (hasFailed(track)) return {.source = progress->source, .frame = failedFrame(track)};
    if (!showsAnswerOf(track) || !progress->snapshot->difference.isMismatch()) return {};
    const Snapshot& snapshot = *progress->snapshot;
    return {.source = snapshot.source, .frame = snapshot.frame, .difference = snapshot.difference};
  }

  /// Draws the button that starts an export.
  void drawExportButton(const TrackReport& track) {
    const Session::FailingFrame failing = failingFrame(track);
    const bool enabled = failing.source != nullptr && !session.jobs.get<CaseExport>().running();
    if (!wideButton("Export case…",
                    "Write the smallest recording on which the algorithm still fails", enabled)) {
      return;
    }
    files.ask({.title = "Export the smallest recording that fails",
               .purpose = FileDialog::Purpose::save,
               .extensions = boxRecordingExtensions(),
               .suggestion = fmt::format("{}{}", partName(progress->scene),
                                         recordingExtension(progress->scene)),
               .chosen = [this, test_case = track.spec.test_case, failing](const auto& file) {
                 session.exportCase(test_case, failing, file);
               }});
  }

  void drawExport() {
    CaseExport& case_export = session.jobs.get<CaseExport>();
    const CaseExport::Report report = case_export.report();
    if (report.state == TaskState::idle) return;
    const auto scope = ui.scope("export");
    ImGui::PushID("export");
    if (report.state == TaskState::running) {
      const double whole = static_cast<double>(report.original_bodies * report.original_frames);
      const double remaining = static_cast<double>(report.progress.bodies * report.progress.frames);
      ImGui::ProgressBar(
          static_cast<float>(whole > 0 ? 1 - remaining / whole : 1), {-1, 0},
          fmt::format("{}, {} runs", extentText(report.progress.bodies, report.progress.frames),
                      report.progress.trials)
              .c_str());
      if (ui.button("Cancel", "Stop; nothing is written")) case_export.cancel();
    } else if (report.state == TaskState::done) {
      drawExported(report);
    } else {
      const bool failed = report.state == TaskState::failed;
      ui.coloured(failed ? ui.theme.bad : ui.theme.faint,
                  fmt::format("export {}", kTaskStates.nameOf(report.state)));
    }
    ImGui::PopID();
  }

  void drawExported(const CaseExport::Report& report) {
    ui.coloured(ui.theme.good,
                fmt::format("{} of {}", extentText(report.progress.bodies, report.progress.frames),
                            extentText(report.original_bodies, report.original_frames)));
    ui.tooltip(report.file.c_str());
    std::string command = report.command;
    ImGui::SetNextItemWidth(-1);
    ImGui::InputText("##command", &command, ImGuiInputTextFlags_ReadOnly);
    ui.note("command");
    ui.tooltip(command.c_str());
    if (ui.button("Copy", "Copy the command that reproduces the fault")) {
      ImGui::SetClipboardText(report.command.c_str());
    }
    ImGui::SameLine();
    if (ui.button("Open it", "Open the exported recording")) {
      session.openExport(report);
    }
  }

  void drawPair() {
    const auto& bodies = session.selection.bodies();
    const auto& snapshot = progress->snapshot;
    ui.heading("Pair");
    if (bodies.size() != 2 || !snapshot || bodies[1] >= snapshot->boxes->size()) {
      ui.paragraph("Click a pair above, or select two bodies.");
      return;
    }
    const auto [a, b] = nearestImages((*snapshot->boxes)[bodies[0]], (*snapshot->boxes)[bodies[1]],
                                      snapshot->scene.periodic);
    const BoxPair pair{{bodies[0], bodies[1]}, a, b};
    ui.paragraph(view.answer().pair);
    const std::string filtered = filterText(snapshot->scene.filter, pair.bodies);
    if (!filtered.empty()) ui.coloured(ui.theme.warning, filtered);
    if (isEmpty(pair.a) || isEmpty(pair.b)) {
      for (const Trail& trail : snapshot->trails) {
        if (!isEmpty(trail.boxes.back())) continue;
        ui.coloured(ui.theme.bad, fmt::format("body {}: {}", trail.body, absenceText(trail)));
      }
      return;
    }
    ui.coloured(overlaps(pair.a, pair.b) ? ui.theme.good : ui.theme.bad, relationText(pair));
    drawPairTable(ui, pair);
    drawIntervals(ui, pair);
    drawHistory(pair);
  }

  /// Returns a text like "they overlap, least on y".
  static std::string relationText(const BoxPair& pair) {
    const std::size_t axis = maxSeparationAxis(pair.a, pair.b);
    const AxisRelation relation = axisRelation(axis, pair.a, pair.b);
    constexpr NameTable kSentences{
        {NamedValue{AxisRelation::Type::overlap, "they overlap, least on"},
         {AxisRelation::Type::touch, "they overlap, just touching on"},
         {AxisRelation::Type::gap, "they are apart, most on"}}};
    return fmt::format("{} {}", kSentences.nameOf(relation.type), kAxes[axis]);
  }

  void drawHistory(const BoxPair& pair) {
    const std::vector<Trail>& trails = progress->snapshot->trails;
    if (trails.size() != 2 || trails[0].body != pair.bodies.a || trails[1].body != pair.bodies.b) {
      return;
    }
    const PairTrails trail{trails[0], trails[1], progress->snapshot->scene.periodic};
    ui.heading("History");
    const auto overlap_start = trail.overlapStart();
    if (!overlap_start) {
      ui.faint(fmt::format("frames {} to {}: apart at the end", trails[0].first,
                           trails[0].first + trail.size() - 1));
    } else if (*overlap_start == trails[0].first) {
      ui.faint(fmt::format("overlapping since frame {} or earlier", *overlap_start));
    } else {
      ui.faint(fmt::format("overlapping since frame {}", *overlap_start));
    }
    if (const auto clicked = drawPairHistory(ui, trail)) {
      session.playback.goTo(*clicked);
    }
  }

  void drawStructure() {
    ui.heading("Inside the algorithm");
    ui.toggle("Show structure", session.display.structure,
              "Draw the algorithm's cells, nodes or planes around the pair");
    for (const TrackReport& track : progress->tracks) {
      if (track.spec.number != session.tracks.shown()) continue;
      if (track.margin > 0) ui.valueRow("margin", fmt::format("{}", track.margin));
      const auto& snapshot = progress->snapshot;
      const Counts none;
      const bool is_shown = snapshot && snapshot->track == track.spec.number;
      for (const auto* counts : {&track.setup, is_shown ? &snapshot->counters : &none}) {
        for (const auto& [name, count] : *counts) ui.valueRow(name.c_str(), std::to_string(count));
      }
    }
  }
};

}  // namespace

extern const PanelSpec spec = {"Mismatches", DockArea::right,
                               "Find missed, false and invalid pairs, and their causes",
                               make<MismatchesPanel>};

}  // namespace broadmark::panels::mismatches
